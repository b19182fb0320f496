// Independent watchdog (RM0090, chapter IWDG).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct IndependentWatchdog {
  struct KR : Register<base + 0x00> {};
  struct RLR : Register<base + 0x08> {
    using RL = Field<RLR, 0, 12>;
  };
  struct SR : Register<base + 0x0C> {};
};

}  // namespace inkwell::registers
