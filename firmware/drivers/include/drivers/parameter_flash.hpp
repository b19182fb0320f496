// Erases and programs sectors of the flash that hold parameters. While it does, each fetch and each read of the flash
// waits, that of this code too: the main loop stands still for 16 us a word (100 us on the slowest chip) and for a
// quarter of a second (half a second) a sector, but interrupts, which run from the RAM, go on.
#pragma once

#include <array>
#include <cstdint>

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class ParameterFlash {
 public:
  static constexpr std::array claims{peripheral<registers::FLASH_PROGRAMMING>()};

  /// Programs a word that is erased; false if it does not read as `value` then.
  [[nodiscard]] bool program(volatile std::uint32_t* place, std::uint32_t value);
  /// The sector of 16 KB that begins at `begin`.
  void erase(const volatile std::uint32_t* begin);
};

}  // namespace inkwell::drivers
