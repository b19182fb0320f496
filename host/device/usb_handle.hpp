// An open device of libusb, found by what it says of itself.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <process/fork.hpp>

struct libusb_context;
struct libusb_device_handle;

namespace inkwell::device {

/// Context and handle; what was claimed is released with it.
class UsbHandle {
 public:
  /// Throws NoPermission, InUse, Disconnected if no such device is there, or Error.
  UsbHandle(std::uint16_t vendor_id, std::uint16_t product_id, const std::string& serial_number);
  ~UsbHandle();
  UsbHandle(const UsbHandle&) = delete;
  UsbHandle& operator=(const UsbHandle&) = delete;

  /// Throws InUse with this sentence if another program has it, NoPermission without a driver, or Disconnected.
  void claim(int interface_number, const char* in_use);
  libusb_context* context() const { return context_; }
  libusb_device_handle* get() const { return handle_; }

 private:
  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  std::vector<int> claimed_;
  std::vector<process::OwnDescriptor> own_;  ///< else a child would keep what was claimed
};

/// Serial numbers of those that are there. Throws NoPermission or InUse if one of them cannot be opened.
std::vector<std::string> usb_serial_numbers(std::uint16_t vendor_id, std::uint16_t product_id);

}  // namespace inkwell::device
