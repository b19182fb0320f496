#pragma once

#include <device/device.hpp>
#include <protocol/reports.hpp>

namespace inkwell::command_line {

/// The next pose; throws device::Error if the device is silent for two seconds of waiting.
protocol::PoseReport next_pose(device::Device& device);

}  // namespace inkwell::command_line
