// Opens an arm and starts a virtual board if necessary.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/client/device/address.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"

namespace inkwell::device {

struct OpenArm {
  std::unique_ptr<VirtualBoard> board;   ///< started for this arm
  std::optional<ControlClient> control;  ///< control socket of `board`, or of the virtual board that the address names
  Endpoint endpoint{};
  std::unique_ptr<Device> device;
  std::string arm_name;  ///< from the arm description, or empty
  /// Files of a virtual board that was started for this arm, otherwise empty. Without an arm description,
  /// `arm_description` is empty.
  std::filesystem::path image, arm_description;
};

/// Opens the arm at the address and throws Error or NoDevice on failure. For an `own_board` address, starts a virtual
/// board and sends the parameters of the arm description to it. A board that starts paused enters standby. If
/// `lock_step` is not null, a virtual board uses it.
OpenArm open_arm(const Address& address, VirtualBoardOptions board_options, LockStep* lock_step = nullptr);

/// Returns the parameters in an arm description. Throws Error with the line number of a mistake.
std::vector<ParameterChange> arm_parameters(const std::filesystem::path& file);

}  // namespace inkwell::device
