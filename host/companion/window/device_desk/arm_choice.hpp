// Chooses the arm that the window connects to. Without a choice by the user, an arm is used only if no other arm is
// connected. Otherwise the force could act on the wrong hand.
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

  /// Returns an empty value if the arm is not connected. Throws device::NoDevice if the user has to choose.
  std::optional<device::Endpoint> pick(const std::vector<device::Endpoint>& found);

 private:
  std::string wanted_;
  std::string taken_;         ///< serial number of the last chosen arm, if it has one
  bool saw_several_ = false;  ///< true: a single arm may differ from the previous arm
};

}  // namespace inkwell::window
