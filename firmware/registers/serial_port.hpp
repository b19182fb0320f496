// Universal synchronous asynchronous receiver transmitter (RM0090, chapter USART), transmitter only.
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct SerialPort {
  struct SR : Register<base + 0x00> {
    using TXE = Field<SR, 7, 1>;
  };
  struct DR : Register<base + 0x04> {};
  struct BRR : Register<base + 0x08> {};
  struct CR1 : Register<base + 0x0C> {
    using TE = Field<CR1, 3, 1>;
    using UE = Field<CR1, 13, 1>;
  };
};

}  // namespace inkwell::registers
