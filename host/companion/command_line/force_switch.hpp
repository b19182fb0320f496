// Switches the force for a command.
#pragma once

#include <optional>
#include <string>

#include "host/client/device/device.hpp"
#include "protocol/reports.hpp"

namespace inkwell::command_line {

/// Switches the force off, even if a different program switched the force on. Waits at most two seconds of board time
/// until the force is off. Returns the newest pose.
device::Pose switch_force_off(device::Device& device);

/// The force is on during the lifetime of this object. The owner must send signs of life to the board.
class ForceSwitch {
 public:
  /// Waits until the force is on. Throws device::Error with the reason if the force cannot be switched on.
  explicit ForceSwitch(device::Device& device);
  ~ForceSwitch();
  ForceSwitch(const ForceSwitch&) = delete;
  ForceSwitch& operator=(const ForceSwitch&) = delete;

  /// Calls switch_force_off(), unless a different program has taken over the arm. Throws device::Error.
  device::Pose switch_off();
  /// Returns the reason if the force is off or a different program has taken over the arm.
  std::optional<std::string> loss(const device::Pose& pose) const;

 private:
  device::Device& device_;
  bool may_be_on_ = true;
};

/// Returns a sentence about the state of the force. If the force is off, the sentence includes cause and remedy.
std::string force_sentence(const device::Pose& pose);

}  // namespace inkwell::command_line
