#include "boards/virtual/usb/descriptors.hpp"

#include <algorithm>

namespace inkwell::virtual_board {

namespace {
constexpr std::uint8_t interface_descriptor = 4;
constexpr std::uint8_t endpoint_descriptor = 5;
}  // namespace

ConfigurationDescription parse_configuration(std::span<const std::byte> bytes) {
  const auto at = [&](std::size_t index) { return std::to_integer<std::uint8_t>(bytes[index]); };
  ConfigurationDescription configuration;
  if (bytes.size() < 9) return configuration;
  configuration.value = at(5);
  std::uint8_t interface = 0;
  std::uint8_t alternate = 0;
  for (std::size_t i = 0; i + 2 <= bytes.size();) {
    const std::size_t length = at(i);
    if (length < 2 || i + length > bytes.size()) break;
    if (at(i + 1) == interface_descriptor && length >= 9) {
      interface = at(i + 2);
      alternate = at(i + 3);
      if (alternate == 0) configuration.interfaces.push_back({at(i + 5), at(i + 6), at(i + 7)});
    } else if (at(i + 1) == endpoint_descriptor && length >= 7) {
      const auto packet_maximum = static_cast<std::uint16_t>((at(i + 4) | at(i + 5) << 8) & 0x7FF);
      configuration.endpoints.push_back({interface, alternate, at(i + 2), static_cast<TransferType>(at(i + 3) & 3),
                                         packet_maximum, std::max<std::uint8_t>(1, at(i + 6))});
    }
    i += length;
  }
  return configuration;
}

}  // namespace inkwell::virtual_board
