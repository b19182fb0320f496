// Names of the pins of the chip, such as PA8.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace inkwell::virtual_board {

struct PinName {
  char port;  ///< 'A' to 'I'
  unsigned pin;
  bool operator==(const PinName&) const = default;

  /// Returns nothing if the name is invalid.
  static std::optional<PinName> find(std::string_view name);
  /// Throws std::invalid_argument if the name is invalid.
  static PinName of(std::string_view name);
  std::string text() const { return std::string("P") + port + std::to_string(pin); }
};

}  // namespace inkwell::virtual_board
