#include "host/client/device/usb_descriptors.hpp"

#include "host/client/device/error.hpp"

namespace inkwell::device {
namespace {

constexpr std::uint8_t type_configuration = 2, type_string = 3, type_interface = 4, type_endpoint = 5;
constexpr std::uint8_t class_hid = 0x03, class_vendor = 0xFF;
constexpr std::uint8_t transfer_bulk = 2, transfer_interrupt = 3;

[[noreturn]] void refuse(const char* what) {
  throw Error(std::string("The device's USB configuration ") + what +
              ". Flash the firmware that belongs to this companion.");
}

}  // namespace

UsbLayout parse_configuration(std::span<const std::byte> descriptor) {
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint8_t>(descriptor[i]); };
  if (descriptor.size() < 9 || at(1) != type_configuration) refuse("is damaged");
  UsbLayout layout;
  layout.configuration = at(5);
  std::uint8_t interface_number = 0, interface_class = 0;
  while (!descriptor.empty()) {
    const std::size_t length = at(0);
    if (length < 2 || length > descriptor.size()) refuse("is damaged");
    if (at(1) == type_interface && length >= 9) {
      interface_number = at(2);
      interface_class = at(5);
    } else if (at(1) == type_endpoint && length >= 7) {
      const std::uint8_t address = at(2), transfer = at(3) & 3u;
      const bool is_in = (address & 0x80u) != 0;
      // The second HID interface is the game controller, so only the first HID interface is used.
      const bool has_hid = layout.hid_in_endpoint != 0 || layout.hid_out_endpoint != 0;
      if (interface_class == class_hid && transfer == transfer_interrupt &&
          (!has_hid || interface_number == layout.hid_interface)) {
        layout.hid_interface = interface_number;
        (is_in ? layout.hid_in_endpoint : layout.hid_out_endpoint) = address;
      } else if (interface_class == class_vendor && transfer == transfer_bulk && is_in) {
        layout.scope_interface = interface_number;
        layout.scope_in_endpoint = address;
      }
    }
    descriptor = descriptor.subspan(length);
  }
  if (layout.hid_in_endpoint == 0 || layout.hid_out_endpoint == 0) refuse("has no HID interface with two endpoints");
  if (layout.scope_in_endpoint == 0) refuse("has no bulk interface for the scope");
  return layout;
}

std::string parse_string(std::span<const std::byte> descriptor) {
  std::string text;
  if (descriptor.size() < 2 || std::to_integer<std::uint8_t>(descriptor[1]) != type_string) return text;
  for (std::size_t i = 2; i + 1 < descriptor.size(); i += 2) {
    const auto low = std::to_integer<std::uint8_t>(descriptor[i]);
    const bool is_ascii = descriptor[i + 1] == std::byte{0} && low >= 0x20 && low < 0x7F;
    text += is_ascii ? static_cast<char>(low) : '?';
  }
  return text;
}

std::uint8_t name_of_alternate(std::span<const std::byte> configuration, std::uint8_t interface,
                               std::uint8_t alternate) {
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint8_t>(configuration[i]); };
  while (configuration.size() >= 2 && at(0) >= 2 && at(0) <= configuration.size()) {
    if (at(1) == type_interface && at(0) >= 9 && at(2) == interface && at(3) == alternate) return at(8);
    configuration = configuration.subspan(at(0));
  }
  return 0;
}

}  // namespace inkwell::device
