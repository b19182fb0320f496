// The force, switched by a command.
#pragma once

#include <optional>
#include <string>

#include <device/device.hpp>
#include <protocol/reports.hpp>

namespace inkwell::command_line {

/// Switches the force off, whoever switched it on, and returns the pose that tells so.
device::Pose switch_force_off(device::Device& device);

/// The force is on from its construction to its end, whatever ends it. Its owner gives signs of life between.
class ForceSwitch {
 public:
  /// Waits until the force is on. Throws device::Error with the reason if it does not come on.
  explicit ForceSwitch(device::Device& device);
  ~ForceSwitch();
  ForceSwitch(const ForceSwitch&) = delete;
  ForceSwitch& operator=(const ForceSwitch&) = delete;

  /// As switch_force_off(), but without effect once another program drives the arm. Throws device::Error.
  device::Pose switch_off();
  /// Why the force is not this program's any more at this pose; none while it is.
  std::optional<std::string> loss(const device::Pose& pose) const;

 private:
  device::Device& device_;
  bool may_be_on_ = true;
};

/// Whether the force is on, and what keeps it off: a sentence with the remedy.
std::string force_sentence(const device::Pose& pose);

}  // namespace inkwell::command_line
