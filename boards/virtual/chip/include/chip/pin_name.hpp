// What a pin of the chip is called, and with it the wire that is soldered to it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace inkwell::virtual_board {

struct PinName {
  char port;  ///< 'A' to 'I'
  unsigned pin;
  bool operator==(const PinName&) const = default;

  /// Of a name such as PA8; none if it is no pin's.
  static std::optional<PinName> find(std::string_view name);
  /// The same; throws std::invalid_argument with a sentence.
  static PinName of(std::string_view name);
  std::string text() const { return std::string("P") + port + std::to_string(pin); }
};

}  // namespace inkwell::virtual_board
