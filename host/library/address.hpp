// What inkwell_open() and inkwell_list_devices() find.
#pragma once

#include <string>
#include <vector>

#include <inkwell/inkwell.h>
#include <device/open_arm.hpp>

namespace inkwell::library {

struct OpenedArm {
  device::OpenArm arm;
  bool is_stepped;  ///< board time passes only while a call of the library waits for it
};

/// What the address of inkwell_open() stands for; what INKWELL_DEVICE says if it is empty. A virtual board is in
/// `lock_step`.
OpenedArm open_arm(const std::string& address, device::LockStep* lock_step);
/// Everything that open_arm() can find, with the address that leads there.
std::vector<inkwell_device> list_devices();

}  // namespace inkwell::library
