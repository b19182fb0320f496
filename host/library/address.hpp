// What inkwell_open() and inkwell_list_devices() find.
#pragma once

#include <string>
#include <vector>

#include <inkwell/inkwell.h>
#include <device/open_arm.hpp>

namespace inkwell::library {

/// What the address of inkwell_open() stands for; what INKWELL_DEVICE says if it is empty.
device::OpenArm open_arm(const std::string& address);
/// Everything that open_arm() can find, with the address that leads there.
std::vector<inkwell_device> list_devices();

}  // namespace inkwell::library
