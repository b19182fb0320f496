// Console on USART2, at 115200 8N1, for bench use before USB works. The firmware prints a few lines after each boot.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

/// The console waits about 0.1 ms for each character, so only start-up code uses the console.
class Console {
 public:
  static constexpr std::array claims{peripheral<registers::USART2>(), pin(board::facts.console_transmit)};

  /// Call this function again when the bus clock has changed.
  void start(std::uint32_t bus_Hz);
  void write(std::string_view text);
  void write_hexadecimal(std::uint32_t word);
};

}  // namespace inkwell::drivers
