// The chip's own CRC-32 of words (RM0090, chapter CRC): polynomial 0x04C11DB7, the highest bit first, from all ones.
#pragma once

#include <cstdint>

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

class Checksum {
 public:
  static constexpr std::array claims{peripheral<registers::CRC>()};

  void start();
  /// Forgets the words so far.
  void begin();
  void add(std::uint32_t word);
  /// Of the words since begin().
  std::uint32_t value() const;
};

}  // namespace inkwell::drivers
