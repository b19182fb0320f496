// Which of the arms that are there the window connects to. One that nobody has named is taken only where no other can
// be meant: the force would come on in another hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <device/address.hpp>

namespace inkwell::window {

class ArmChoice {
 public:
  /// Empty: whichever is there.
  explicit ArmChoice(std::string wanted_serial_number) : wanted_(std::move(wanted_serial_number)) {}

  /// None: it is not there. Throws device::NoDevice with a sentence if the user has to choose.
  std::optional<device::Endpoint> pick(const std::vector<device::Endpoint>& found);

 private:
  std::string wanted_;
  std::string taken_;         ///< the last one, if it has a number
  bool saw_several_ = false;  ///< so that one alone need not be the one that was taken
};

}  // namespace inkwell::window
