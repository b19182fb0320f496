// Stream 0 of the DMA controller (RM0090, chapter DMA). No other stream is used.
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct DirectMemoryAccess {
  struct LISR : Register<base + 0x00> {
    using TCIF0 = Field<LISR, 5, 1>;
  };
  struct LIFCR : Register<base + 0x08> {
    using CFEIF0 = Field<LIFCR, 0, 1>;
    using CDMEIF0 = Field<LIFCR, 2, 1>;
    using CTEIF0 = Field<LIFCR, 3, 1>;
    using CHTIF0 = Field<LIFCR, 4, 1>;
    using CTCIF0 = Field<LIFCR, 5, 1>;
  };
  struct S0CR : Register<base + 0x10> {
    using EN = Field<S0CR, 0, 1>;
    using DIR = Field<S0CR, 6, 2>;
    using CIRC = Field<S0CR, 8, 1>;
    using MINC = Field<S0CR, 10, 1>;
    using PSIZE = Field<S0CR, 11, 2>;
    using MSIZE = Field<S0CR, 13, 2>;
    using CHSEL = Field<S0CR, 25, 3>;
  };
  struct S0NDTR : Register<base + 0x14> {};
  struct S0PAR : Register<base + 0x18> {};
  struct S0M0AR : Register<base + 0x1C> {};
};

}  // namespace inkwell::registers
