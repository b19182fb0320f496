// Finds the arm for a device name of an HDAPI program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <inkwell/inkwell.h>

namespace inkwell::dropins {

/// Returns the names that the user has bound to arms. Throws std::runtime_error for a damaged file.
std::vector<inkwell_named_arm> list_names();

struct ConfiguredArm {
  std::string address;    ///< empty if INKWELL_DEVICE is empty
  bool has_name = false;  ///< INKWELL_DEVICE contains a name
};
/// Returns the arm that INKWELL_DEVICE selects.
ConfiguredArm configured_arm(const std::vector<inkwell_named_arm>& names);

/// Returns the arm with this name, or NULL. Upper and lower case are equal.
const inkwell_named_arm* find_name(const std::vector<inkwell_named_arm>& names, std::string_view name);

/// Returns the address of the arm that the user has bound to a device name. The words "PHANToM", "Omni", "Touch",
/// "Device" and "Arm" of the device name are optional, so that "Left PHANToM" and "Left Device" select the arm "left".
/// Returns an empty text if the user has bound no names. Throws std::runtime_error for an unknown name.
std::string bound_address(const std::vector<inkwell_named_arm>& names, std::string_view device_name);

}  // namespace inkwell::dropins
