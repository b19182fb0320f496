// Opens the device at an address. Starts a virtual board if the address demands one.
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
  std::unique_ptr<VirtualBoard> board;   ///< the board that was started for this arm
  std::optional<ControlClient> control;  ///< control socket of `board`
  Endpoint endpoint{};
  std::unique_ptr<Device> device;
  std::string arm_name;  ///< from the arm description in the address; empty without one, as a board stores no name
};

/// Opens the arm at the address. For an `own_board` address, starts a virtual board with these options and with the arm
/// description in the address. The board receives the parameters of the arm description. A board that starts paused
/// enters standby. The device of a virtual board uses `lock_step` unless `lock_step` is null. Throws Error, or NoDevice
/// if no arm is found.
OpenArm open_arm(const Address& address, VirtualBoardOptions board_options, LockStep* lock_step = nullptr);

/// Returns the parameters in an arm description. Throws Error with the line number of a mistake.
std::vector<ParameterChange> arm_parameters(const std::filesystem::path& file);

}  // namespace inkwell::device
