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

/// Opens the arm at an address in the format of inkwell_open(). An empty address selects the address in INKWELL_DEVICE.
/// Arms on USB ignore `lock_step`.
OpenedArm open_arm(const std::string& address, device::LockStep* lock_step);
/// Lists the available arms and their addresses. The order is that of inkwell_list_devices().
std::vector<inkwell_device> list_devices();
/// Lists the names of arms and their addresses. Throws Error for a damaged file.
std::vector<inkwell_named_arm> list_names();

}  // namespace inkwell::library
