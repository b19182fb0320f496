// Some lines of text after each start, on USART2 at 115200 8N1: for the bench, before USB speaks.
#pragma once

#include <cstdint>
#include <string_view>

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

/// Waits for each character to leave, about 0.1 ms: for start-up only.
class Console {
 public:
  static constexpr std::array claims{peripheral<registers::USART2>(), pin(board::facts.console_transmit)};

  /// Also again, when the clock of its bus has changed.
  void start(std::uint32_t bus_Hz);
  void write(std::string_view text);
  void write_hexadecimal(std::uint32_t word);
};

}  // namespace inkwell::drivers
