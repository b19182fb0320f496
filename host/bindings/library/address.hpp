// Finds the arms for inkwell_open() and inkwell_list_devices().
#pragma once

#include <string>
#include <vector>

#include <inkwell/inkwell.h>
#include "host/client/device/open_arm.hpp"

namespace inkwell::library {

struct OpenedArm {
  device::OpenArm arm;
  bool is_stepped;  ///< board time passes only while a call of the library waits for it
};

/// Opens the arm at an address of inkwell_open(). An empty address stands for the address in INKWELL_DEVICE. A virtual
/// board uses `lock_step`.
OpenedArm open_arm(const std::string& address, device::LockStep* lock_step);
/// Lists the arms that open_arm() can find, with their addresses.
std::vector<inkwell_device> list_devices();

}  // namespace inkwell::library
