// Notes in a recording what the poses of a device show: force, faults, buttons, force sources and losses.
#pragma once

#include <cstdint>
#include <optional>

#include "host/client/device/hand_events.hpp"
#include "host/client/recording/recorder.hpp"

namespace inkwell::recording {

/// Call every function from the same thread.
class EventFeed {
 public:
  explicit EventFeed(Recorder& recorder) : recorder_(recorder) {}

  /// Call this function for each pose that arrives.
  void take(const device::Pose& pose);
  /// Number of lost poses since the first pose.
  std::uint64_t lost_poses() const { return lost_poses_; }

 private:
  Recorder& recorder_;
  device::HandEvents hand_;
  std::optional<device::Pose> before_;
  std::uint64_t lost_poses_ = 0, noted_samples_ = 0;
};

}  // namespace inkwell::recording
