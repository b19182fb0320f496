// Cyclic redundancy check (RM0090, chapter CRC).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct ChecksumUnit {
  struct DR : Register<base + 0x00> {};
  struct CR : Register<base + 0x08> {
    using RESET = Field<CR, 0, 1>;
  };
};

}  // namespace inkwell::registers
