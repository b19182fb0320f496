// Parameter edits of the user, with undo and redo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/client/device/device.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::window {

/// Contains the device's values and the unconfirmed edits.
class ParameterEditor {
 public:
  /// Call after each read of the device's parameters.
  void device_holds(const protocol::ParameterSet& held);
  /// Call when the device has refused the newest transaction. Discards the pending edits and their undo step.
  void refused();
  void disconnected();
  /// Call once per frame. Discards edits that the device has not confirmed within one second.
  void forget_unconfirmed(double now_s);

  bool known() const { return held_.has_value(); }
  float shown(protocol::Parameter parameter) const;
  protocol::ParameterSet shown() const;
  bool differs_from_default(protocol::Parameter parameter) const;

  /// One undo step contains all edits between begin_step() and end_step(). Example: a slider drag.
  void begin_step(std::string title);
  void edit(std::span<const device::ParameterChange> changes, double now_s);
  void end_step();
  /// Applies all changes as one undo step.
  void apply(std::string title, std::span<const device::ParameterChange> changes, double now_s);

  bool can_undo() const { return position_ > 0; }
  bool can_redo() const { return position_ < steps_.size(); }
  const std::string& undo_title() const { return steps_[position_ - 1].title; }
  const std::string& redo_title() const { return steps_[position_].title; }
  void undo(double now_s);
  void redo(double now_s);

  /// Returns the changes for the next transaction; empty if there are no changes.
  std::vector<device::ParameterChange> take_changes();

 private:
  struct Difference {
    protocol::Parameter parameter;
    float before;
    float after;
  };
  struct Step {
    std::string title;
    std::vector<Difference> differences;
    bool confirmed = false;
  };
  struct Wanted {
    float value;
    double since_s;
  };

  void want(protocol::Parameter parameter, float value, double now_s);

  std::optional<protocol::ParameterSet> held_;
  std::array<std::optional<Wanted>, std::tuple_size_v<decltype(protocol::ParameterSet::values)>> wanted_{};
  std::vector<device::ParameterChange> outgoing_;
  std::vector<Step> steps_;  // done: [0, position_); undone: [position_, end)
  std::size_t position_ = 0;
  std::optional<Step> open_step_;
};

/// Returns the name in words without the unit, such as "Wall stiffness" for "wall_stiffness_N_per_m".
std::string label_of(const protocol::ParameterInfo& info);
/// Returns the name in words with the group, such as "Box minimum x".
std::string full_label_of(protocol::ParameterInfo info);

/// Returns the number of decimals for a resolution of about 1/10,000 of the parameter's range.
int decimals_of(const protocol::ParameterInfo& info);

/// A complete set of contact parameters for one type of wall.
struct Preset {
  std::string_view name;
  std::string_view help;
  std::vector<device::ParameterChange> changes;
};
std::span<const Preset> presets();

}  // namespace inkwell::window
