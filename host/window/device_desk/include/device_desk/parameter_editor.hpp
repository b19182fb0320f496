// What the user wants the parameters to be, between the sliders and the device: edits, undo and redo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <device/device.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::window {

/// Values shown are those the device holds, except for edits that are still on their way to it.
class ParameterEditor {
 public:
  /// The parameters as the device holds them; call whenever they were read anew.
  void device_holds(const protocol::ParameterSet& held);
  /// The device refused the newest transaction: what was on its way is forgotten, and so is its undo step.
  void refused();
  void disconnected();
  /// Edits the device has not confirmed within a second are shown no longer. Call once a frame.
  void forget_unconfirmed(double now_s);

  bool known() const { return held_.has_value(); }
  float shown(protocol::Parameter parameter) const;
  protocol::ParameterSet shown() const;
  bool differs_from_default(protocol::Parameter parameter) const;

  /// From begin_step to end_step every edit belongs to one undo step (a slider that is dragged).
  void begin_step(std::string title);
  void edit(std::span<const device::ParameterChange> changes, double now_s);
  void end_step();
  /// One undo step of its own.
  void apply(std::string title, std::span<const device::ParameterChange> changes, double now_s);

  bool can_undo() const { return position_ > 0; }
  bool can_redo() const { return position_ < steps_.size(); }
  const std::string& undo_title() const { return steps_[position_ - 1].title; }
  const std::string& redo_title() const { return steps_[position_].title; }
  void undo(double now_s);
  void redo(double now_s);

  /// What has to be sent as one transaction; empty when there is nothing.
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
  std::vector<Step> steps_;  // done: [0, position_), undone: [position_, end)
  std::size_t position_ = 0;
  std::optional<Step> open_step_;
};

/// "wall_stiffness_N_per_m" -> "Wall stiffness": the name in words, without its group and the unit it ends in.
std::string label_of(const protocol::ParameterInfo& info);
/// The same with its group, for where no heading says that: "Box minimum x".
std::string full_label_of(protocol::ParameterInfo info);

/// Digits after the decimal point with which a value of this parameter is shown: about a ten-thousandth of its range.
int decimals_of(const protocol::ParameterInfo& info);

/// A whole set of contact parameters for a feel.
struct Preset {
  std::string_view name;
  std::string_view help;
  std::vector<device::ParameterChange> changes;
};
std::span<const Preset> presets();

}  // namespace inkwell::window
