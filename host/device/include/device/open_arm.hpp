// From an address to an open device, with a virtual board started for it if that is what the address says.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <device/address.hpp>
#include <device/device.hpp>
#include <device/virtual_board.hpp>

namespace inkwell::device {

struct OpenArm {
  std::unique_ptr<VirtualBoard> board;   ///< that was started for it
  std::optional<ControlClient> control;  ///< of `board`
  Endpoint endpoint{};
  std::unique_ptr<Device> device;
};

/// A board of its own is started with these options and the address's arm, whose parameters its firmware gets; if it
/// starts paused, it stands by. With a virtual board, the device is in `lock_step`, unless that is null. Throws Error,
/// as NoDevice if no arm is there.
OpenArm open_arm(const Address& address, VirtualBoardOptions board_options, LockStep* lock_step = nullptr);

/// The rows of the parameter table that an arm description sets. Throws Error that names the line to mend.
std::vector<ParameterChange> arm_parameters(const std::filesystem::path& file);

}  // namespace inkwell::device
