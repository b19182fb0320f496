// Descriptors of the device: USB 2.0 section 9.6, HID 1.11 section 6.2, Microsoft OS 2.0 descriptors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::usb {

enum class DescriptorType : std::uint8_t {
  device = 1,
  configuration = 2,
  string = 3,
  interface = 4,
  endpoint = 5,
  binary_object_store = 15,
  device_capability = 16,
  hid = 0x21,
  firmware_update = 0x21,  ///< same value as `hid`, but used by the firmware update class
  hid_report = 0x22,
};

enum class StringIndex : std::uint8_t {
  languages = 0,
  manufacturer,
  product,
  serial_number,
  hid,
  scope,
  controller,
  firmware_update
};

inline constexpr std::uint8_t configuration_value = 1;

/// bRequest value of the request for the Microsoft OS 2.0 descriptor set, as chosen by the device.
inline constexpr std::uint8_t microsoft_request = 0x20;
/// wIndex of that request.
inline constexpr std::uint16_t microsoft_descriptor_index = 7;

/// Writes the descriptor to `buffer`. The field bcdDevice is the firmware version, for example 0x0123 for 1.2.3. A
/// minor or patch number above 9 becomes 9. Hosts cache device properties for each bcdDevice value.
std::span<const std::byte> device_descriptor(std::span<std::byte> buffer,
                                             const std::array<std::uint8_t, 3>& firmware_version);
std::span<const std::byte> configuration_descriptor();
std::span<const std::byte> binary_object_store();
/// Returns an empty span for an interface that is not HID.
std::span<const std::byte> hid_descriptor(std::uint8_t interface_number);
std::span<const std::byte> hid_report_descriptor(std::uint8_t interface_number);
std::span<const std::byte> microsoft_descriptor_set();

}  // namespace inkwell::usb
