// CRC-32 unit of the chip for words (RM0090, chapter CRC): polynomial 0x04C11DB7, highest bit first, initially all
// ones.
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
  /// Checksum of the words since begin().
  std::uint32_t value() const;
};

}  // namespace inkwell::drivers
