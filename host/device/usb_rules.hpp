// Differences between operating systems in opening USB devices. The rules of each system are data, so that tests on one
// system cover the decisions for all of them.
#pragma once

#include <string>

namespace inkwell::device {

struct UsbRules {
  bool restricts_users;  ///< the system decides by user which device may be opened; else a program may exclude others
  const char* driver_advice;  ///< sentence for a device without a driver that libusb can use
};

inline constexpr UsbRules linux_usb_rules{true, "Plug the device in again."};
/// WinUSB admits one program per device. The boot loader in the chip has no descriptors that select WinUSB.
inline constexpr UsbRules windows_usb_rules{
    false, "Install the driver WinUSB for this device, for example with the program Zadig, then try again."};
/// This program's system. A port to another one chooses here.
inline constexpr const UsbRules& usb_rules = linux_usb_rules;

/// Throws the error for an interface that libusb_open or libusb_claim_interface refused with `code`: NoPermission,
/// InUse with the sentence `in_use`, or Disconnected.
[[noreturn]] void throw_libusb_refusal(int code, const char* in_use, const UsbRules& rules = usb_rules);

/// Throws the error for an interface that is listed at `path` but that hidapi did not open: NoPermission or InUse.
/// `detail`: text of hid_error.
[[noreturn]] void throw_hidapi_refusal(const std::string& path, const std::string& detail,
                                       const UsbRules& rules = usb_rules);

/// The sentence with the text that a library returned, if the library returned one.
std::string with_detail(const std::string& sentence, const std::string& detail);

}  // namespace inkwell::device
