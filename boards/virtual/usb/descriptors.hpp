// Contents of USB descriptors (USB 2.0, section 9.6).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace inkwell::virtual_board {

enum class TransferType : std::uint8_t { control, isochronous, bulk, interrupt };

struct EndpointDescription {
  std::uint8_t interface;
  std::uint8_t alternate;
  std::uint8_t address;  ///< bit 7: IN
  TransferType type;
  std::uint16_t packet_maximum;
  std::uint8_t interval_frames;  ///< of interrupt endpoints, at least 1
};

struct InterfaceDescription {
  std::uint8_t interface_class;
  std::uint8_t interface_subclass;
  std::uint8_t interface_protocol;
};

struct ConfigurationDescription {
  std::uint8_t value = 0;
  std::vector<InterfaceDescription> interfaces;  ///< alternate 0 of each
  std::vector<EndpointDescription> endpoints;    ///< of all alternates
};

struct DeviceDescription {
  std::array<std::byte, 18> device{};
  std::vector<ConfigurationDescription> configurations;

  std::uint8_t byte(std::size_t index) const { return std::to_integer<std::uint8_t>(device[index]); }
  std::uint16_t word(std::size_t index) const { return static_cast<std::uint16_t>(byte(index) | byte(index + 1) << 8); }
  std::uint16_t vendor() const { return word(8); }
  std::uint16_t product() const { return word(10); }
  std::uint16_t release() const { return word(12); }
  std::uint8_t configuration_count() const { return byte(17); }
};

/// Parses a configuration descriptor and the following descriptors. The result contains all descriptors before the
/// first damaged descriptor.
ConfigurationDescription parse_configuration(std::span<const std::byte> bytes);

}  // namespace inkwell::virtual_board
