// Chooses the arm for the window. If several arms are connected, the user must choose, so that the force does not act
// on the wrong hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/client/device/address.hpp"

namespace inkwell::window {

class ArmChoice {
 public:
  /// An empty serial number accepts any arm.
  explicit ArmChoice(std::string wanted_serial_number) : wanted_(std::move(wanted_serial_number)) {}

  /// Returns an empty value if the arm is not connected. Throws device::NoDevice if the user must choose an arm.
  std::optional<device::Endpoint> pick(const std::vector<device::Endpoint>& found);

 private:
  std::string wanted_;
  std::string taken_;         ///< serial number of the last chosen arm, if it has one
  bool saw_several_ = false;  ///< true: a single arm may differ from the previous arm
};

}  // namespace inkwell::window
