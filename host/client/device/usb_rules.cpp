#include "host/client/device/usb_rules.hpp"

#include <libusb-1.0/libusb.h>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

#include "host/client/device/transports.hpp"

namespace inkwell::device {

void throw_libusb_refusal(int code, const char* in_use, const UsbRules& rules) {
  switch (code) {
    case LIBUSB_ERROR_BUSY: throw InUse(in_use);
    case LIBUSB_ERROR_ACCESS:
      if (rules.restricts_users) throw NoPermission(permission_message("/dev/bus/usb"));
      throw InUse(in_use);
    case LIBUSB_ERROR_NOT_SUPPORTED:
    case LIBUSB_ERROR_NOT_FOUND:
      throw NoPermission(fmt::format("The device has no driver that this program can use. {}", rules.driver_advice));
    default: throw Disconnected(unplugged);
  }
}

void throw_hidapi_refusal(const std::string& path, const std::string& detail, const UsbRules& rules) {
  if (rules.restricts_users) throw NoPermission(with_detail(permission_message(path), detail));
  throw InUse(with_detail("The arm cannot be opened. Close the other program that uses the arm.", detail));
}

std::string with_detail(const std::string& sentence, const std::string& detail) {
  return detail.empty() ? sentence : fmt::format("{} The system reports: {}", sentence, detail);
}

}  // namespace inkwell::device
