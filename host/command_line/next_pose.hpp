#pragma once

#include <device/device.hpp>
#include <protocol/reports.hpp>

namespace inkwell::command_line {

/// What a user is told, with the remedy.
inline constexpr const char* device_is_silent =
    "The device is silent. Reset the board, or let a paused virtual board run.";

/// The next pose; throws device::Error if the device is silent for two seconds of waiting.
device::Pose next_pose(device::Device& device);

}  // namespace inkwell::command_line
