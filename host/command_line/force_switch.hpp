// Switches the force for a command.
#pragma once

#include <optional>
#include <string>

#include <device/device.hpp>
#include <protocol/reports.hpp>

namespace inkwell::command_line {

/// Switches the force off, whichever program switched it on. Returns the first pose that shows this.
device::Pose switch_force_off(device::Device& device);

/// The force is on during the lifetime of this object. The owner must send signs of life.
class ForceSwitch {
 public:
  /// Waits until the force is on. Throws device::Error with the reason if it does not come on.
  explicit ForceSwitch(device::Device& device);
  ~ForceSwitch();
  ForceSwitch(const ForceSwitch&) = delete;
  ForceSwitch& operator=(const ForceSwitch&) = delete;

  /// Like switch_force_off(), but without effect after another program has taken over the arm. Throws device::Error.
  device::Pose switch_off();
  /// Reason why this program has lost the force, based on this pose; none if it has not.
  std::optional<std::string> loss(const device::Pose& pose) const;

 private:
  device::Device& device_;
  bool may_be_on_ = true;
};

/// A sentence that states whether the force is on, and otherwise the cause and the remedy.
std::string force_sentence(const device::Pose& pose);

}  // namespace inkwell::command_line
