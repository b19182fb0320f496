// Parses the configuration descriptor of the device (USB 2.0, chapter 9; HID 1.11, section 6.2.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace inkwell::device {

struct UsbLayout {
  std::uint8_t configuration = 0;
  std::uint8_t hid_interface = 0;
  std::uint8_t hid_in_endpoint = 0;  ///< includes the direction bit
  std::uint8_t hid_out_endpoint = 0;
  std::uint8_t scope_interface = 0;
  std::uint8_t scope_in_endpoint = 0;  ///< includes the direction bit
};

/// Throws Error if the descriptor is damaged or a required interface is missing.
UsbLayout parse_configuration(std::span<const std::byte> descriptor);

/// Returns the text of a string descriptor. Replaces characters outside ASCII by '?'.
std::string parse_string(std::span<const std::byte> descriptor);

/// Returns the string index of an alternate setting's name, or 0 without a name. Parsing stops at the first error.
std::uint8_t name_of_alternate(std::span<const std::byte> configuration, std::uint8_t interface,
                               std::uint8_t alternate);

/// Setup packet of a control transfer (USB 2.0, section 9.3).
struct Setup {
  std::uint8_t request_type;
  std::uint8_t request;
  std::uint16_t value;
  std::uint16_t index;
  std::uint16_t length;
};

namespace setup {

enum class DescriptorType : std::uint8_t { device = 1, configuration = 2, string = 3 };

constexpr Setup get_descriptor(DescriptorType type, std::uint8_t index, std::uint16_t length) {
  const std::uint16_t language = type == DescriptorType::string ? 0x0409 : 0;
  return {0x80, 6, static_cast<std::uint16_t>(static_cast<unsigned>(type) << 8 | index), language, length};
}
constexpr Setup set_configuration(std::uint8_t configuration) { return {0x00, 9, configuration, 0, 0}; }

/// The value 3 in the high byte of wValue selects a feature report (HID 1.11, section 7.2).
constexpr Setup get_feature_report(std::uint8_t interface, std::uint8_t id, std::uint16_t length) {
  return {0xA1, 0x01, static_cast<std::uint16_t>(0x0300 | id), interface, length};
}
constexpr Setup set_feature_report(std::uint8_t interface, std::uint8_t id, std::uint16_t length) {
  return {0x21, 0x09, static_cast<std::uint16_t>(0x0300 | id), interface, length};
}

}  // namespace setup
}  // namespace inkwell::device
