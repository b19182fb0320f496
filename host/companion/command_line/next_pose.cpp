#include "host/companion/command_line/next_pose.hpp"

#include <chrono>

namespace inkwell::command_line {

// The limit excludes the time during which the program is suspended.
device::Pose next_pose(device::Device& device) {
  constexpr int waits = 10;
  constexpr std::chrono::milliseconds wait{200};
  for (int i = 0; i < waits; ++i)
    if (const auto pose = device.read_pose(wait)) return *pose;
  throw device::Error(device_is_silent);
}

}  // namespace inkwell::command_line
