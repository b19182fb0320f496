// The chip's CRC-32 unit (RM0090, chapter CRC) processes words, highest bit first. The polynomial is 0x04C11DB7, and
// the initial value is 0xFFFFFFFF.
#pragma once

#include <cstdint>

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

class Checksum {
 public:
  static constexpr std::array claims{peripheral<registers::CRC>()};

  void start();
  /// Discards the previous words.
  void begin();
  void add(std::uint32_t word);
  /// Returns the checksum of all words since begin().
  std::uint32_t value() const;
};

}  // namespace inkwell::drivers
