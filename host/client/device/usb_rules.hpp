// Rules by which operating systems open USB devices. The rules of each system are data, so that tests on one system
// cover the decisions for all systems.
#pragma once

#include <string>

namespace inkwell::device {

struct UsbRules {
  bool restricts_users;       ///< true: access depends on the user; false: another program may have exclusive access
  const char* driver_advice;  ///< advice for a device without a driver that libusb can use
};

inline constexpr UsbRules linux_usb_rules{true, "Plug the device in again."};
/// WinUSB allows one program per device. The boot loader in the chip has no descriptors that select WinUSB.
inline constexpr UsbRules windows_usb_rules{
    false, "Install the driver WinUSB for this device, for example with the program Zadig, then try again."};
/// The rules of this system. A port to another system selects its rules here.
inline constexpr const UsbRules& usb_rules = linux_usb_rules;

/// Throws the error for the result `code` of libusb_open or libusb_claim_interface. The error is NoPermission,
/// Disconnected, or InUse with the sentence `in_use`.
[[noreturn]] void throw_libusb_refusal(int code, const char* in_use, const UsbRules& rules = usb_rules);

/// Throws NoPermission or InUse for the interface at `path`, which hidapi could not open. `detail`: text of hid_error.
[[noreturn]] void throw_hidapi_refusal(const std::string& path, const std::string& detail,
                                       const UsbRules& rules = usb_rules);

/// The sentence, followed by the error text of the library, if any.
std::string with_detail(const std::string& sentence, const std::string& detail);

}  // namespace inkwell::device
