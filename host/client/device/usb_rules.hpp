// Rules of an operating system for access to USB devices.
#pragma once

#include <string>

namespace inkwell::device {

struct UsbRules {
  bool restricts_users;       ///< true: access depends on the user; false: a device can be open in only one program
  const char* driver_advice;  ///< advice if no driver is installed for a device
};

inline constexpr UsbRules linux_usb_rules{true, "Plug the device in again."};
/// WinUSB allows only one program per device.
inline constexpr UsbRules windows_usb_rules{
    false, "Install the driver WinUSB for this device, for example with the program Zadig, then try again."};
/// A port to another system selects its rules here.
inline constexpr const UsbRules& usb_rules = linux_usb_rules;

/// Throws the error for a failed libusb_open or libusb_claim_interface with result `code`. The error is NoPermission,
/// Disconnected, or InUse with the sentence `in_use`.
[[noreturn]] void throw_libusb_refusal(int code, const char* in_use, const UsbRules& rules = usb_rules);

/// Throws NoPermission or InUse if hidapi could not open the interface at `path`. `detail` is the text of hid_error.
[[noreturn]] void throw_hidapi_refusal(const std::string& path, const std::string& detail,
                                       const UsbRules& rules = usb_rules);

/// Appends the error text of a library, if any, to the sentence.
std::string with_detail(const std::string& sentence, const std::string& detail);

}  // namespace inkwell::device
