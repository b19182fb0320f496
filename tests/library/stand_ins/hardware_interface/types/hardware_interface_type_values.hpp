// Stand-in for the header of ros2_control: the names of the interfaces that the example uses.
#pragma once

namespace hardware_interface {
inline constexpr char HW_IF_POSITION[] = "position", HW_IF_VELOCITY[] = "velocity", HW_IF_EFFORT[] = "effort";
}  // namespace hardware_interface
