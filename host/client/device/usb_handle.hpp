// Opens a libusb device by its identifiers and serial number.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/client/process/fork.hpp"

struct libusb_context;
struct libusb_device_handle;

namespace inkwell::device {

/// The destructor releases all claimed interfaces.
class UsbHandle {
 public:
  /// Throws NoPermission, InUse, or Error. Throws Disconnected if no matching device is connected.
  UsbHandle(std::uint16_t vendor_id, std::uint16_t product_id, const std::string& serial_number);
  ~UsbHandle();
  UsbHandle(const UsbHandle&) = delete;
  UsbHandle& operator=(const UsbHandle&) = delete;

  /// Throws Disconnected, or NoPermission if no driver is installed. Throws InUse with the sentence `in_use` if another
  /// program has claimed the interface.
  void claim(int interface_number, const char* in_use);
  libusb_context* context() const { return context_; }
  libusb_device_handle* get() const { return handle_; }

 private:
  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  std::vector<int> claimed_;
  std::vector<process::OwnDescriptor> own_;  ///< closes the interfaces in forked children
};

/// Returns the serial numbers of the connected devices. Throws NoPermission or InUse if a device cannot be opened.
std::vector<std::string> usb_serial_numbers(std::uint16_t vendor_id, std::uint16_t product_id);

}  // namespace inkwell::device
