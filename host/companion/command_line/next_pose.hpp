#pragma once

#include "host/client/device/device.hpp"
#include "protocol/reports.hpp"

namespace inkwell::command_line {

inline constexpr const char* device_is_silent =
    "The device is silent. Reset the board, or let a paused virtual board run.";

/// Returns the next pose. Throws device::Error after two seconds without a pose.
device::Pose next_pose(device::Device& device);

}  // namespace inkwell::command_line
