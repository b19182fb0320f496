// Events of the hand for logs and recordings: pressed buttons, and the sources of the force that the hand feels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/client/device/event.hpp"
#include "host/client/device/program_force.hpp"

namespace inkwell::device {

/// Use one object for each connection.
class HandEvents {
 public:
  /// Shortest board time between two events of force sources. A probe that bounces on a wall changes them each
  /// millisecond; the signal force_sources shows each change.
  static constexpr double source_interval_s = 0.05;

  /// Returns the events since the previous pose. The first pose has events only of pressed buttons and active sources.
  std::vector<Event> take(const Pose& pose);

 private:
  std::uint8_t switches_ = 0, force_sources_ = 0;
  std::optional<std::int64_t> sources_noted_at_periods_;
};

/// Returns an event for each placed shape with all values of the shape, or one event without shapes.
std::vector<Event> events_of_shapes(const Shapes& shapes, std::int64_t at_periods);

/// Returns an event for poses that were lost before this pose, if any.
std::optional<Event> event_of_lost_poses(std::uint64_t lost, std::int64_t at_periods);

}  // namespace inkwell::device
