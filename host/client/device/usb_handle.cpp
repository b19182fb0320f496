#include "host/client/device/usb_handle.hpp"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <array>

#include "protocol/plain_text.hpp"

#include "host/client/device/transports.hpp"
#include "host/client/device/usb_rules.hpp"

namespace inkwell::device {
namespace {

constexpr char no_libusb[] = "libusb cannot be initialized. Check that /dev/bus/usb exists.";
constexpr char open_elsewhere[] = "The device is open in another program. Close that program.";

/// Opens each device with these identifiers and calls `take` with its serial number and handle. Closes the handle if
/// `take` returns false. Returns 0, or the error code of the last device that could not be opened.
template <class Take>
int open_each(libusb_context* context, std::uint16_t vendor_id, std::uint16_t product_id, Take take) {
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  int reason = 0;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(list[i], &descriptor);
    if (descriptor.idVendor != vendor_id || descriptor.idProduct != product_id) continue;
    libusb_device_handle* handle = nullptr;
    if (const int opened = libusb_open(list[i], &handle); opened != 0) {
      reason = opened;
      continue;
    }
    std::array<unsigned char, 128> serial{};
    const int length =
        libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber, serial.data(), serial.size());
    // The conversion makes serial numbers from libusb and hidapi comparable.
    const std::string found = protocol::plain_text(
        {reinterpret_cast<const char*>(serial.data()), static_cast<std::size_t>(std::max(length, 0))});
    if (!take(found, handle)) libusb_close(handle);
  }
  if (list != nullptr) libusb_free_device_list(list, 1);
  return reason;
}

/// Returns true if the device is connected but cannot be opened.
bool shows_closed_device(int reason) {
  return reason == LIBUSB_ERROR_ACCESS || reason == LIBUSB_ERROR_NOT_SUPPORTED || reason == LIBUSB_ERROR_NOT_FOUND;
}

std::vector<process::OwnDescriptor> descriptors_of(libusb_context* context) {
  std::vector<process::OwnDescriptor> own;
  const libusb_pollfd** const all = libusb_get_pollfds(context);
  for (const libusb_pollfd** each = all; each != nullptr && *each != nullptr; ++each) own.emplace_back((*each)->fd);
  libusb_free_pollfds(all);
  return own;
}

}  // namespace

UsbHandle::UsbHandle(std::uint16_t vendor_id, std::uint16_t product_id, const std::string& serial_number) {
  if (libusb_init(&context_) != 0) throw Error(no_libusb);
  const int reason =
      open_each(context_, vendor_id, product_id, [&](const std::string& found, libusb_device_handle* handle) {
        if (handle_ != nullptr || found != serial_number) return false;
        handle_ = handle;
        return true;
      });
  if (handle_ != nullptr) {
    own_ = descriptors_of(context_);
    return;
  }
  libusb_exit(context_);
  throw_libusb_refusal(reason, open_elsewhere);
}

UsbHandle::~UsbHandle() {
  own_.clear();
  for (const int number : claimed_) libusb_release_interface(handle_, number);
  libusb_close(handle_);
  libusb_exit(context_);
}

void UsbHandle::claim(int interface_number, const char* in_use) {
  const int result = libusb_claim_interface(handle_, interface_number);
  if (result != 0) throw_libusb_refusal(result, in_use);
  claimed_.push_back(interface_number);
}

std::vector<std::string> usb_serial_numbers(std::uint16_t vendor_id, std::uint16_t product_id) {
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) throw Error(no_libusb);
  std::vector<std::string> numbers;
  const int reason = open_each(context, vendor_id, product_id, [&](const std::string& found, libusb_device_handle*) {
    numbers.push_back(found);
    return false;
  });
  libusb_exit(context);
  if (shows_closed_device(reason)) throw_libusb_refusal(reason, open_elsewhere);
  return numbers;
}

}  // namespace inkwell::device
