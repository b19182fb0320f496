// Erases and programs the flash sectors for parameters. Code in flash stops during programming and erasing. Programming
// stops the main loop for 16 us per word, or 100 us on the slowest chip. Erasing stops the main loop for 0.25 s per
// sector, or 0.5 s on the slowest chip. Interrupts run from RAM and continue.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class ParameterFlash {
 public:
  static constexpr std::array claims{peripheral<registers::FLASH_PROGRAMMING>()};

  /// Programs an erased word. Returns false if the word does not read as `value` afterwards.
  [[nodiscard]] bool program(volatile std::uint32_t* address, std::uint32_t value);
  /// Erases the 16 KB sector that starts at `begin`.
  void erase(const volatile std::uint32_t* begin);
};

}  // namespace inkwell::drivers
