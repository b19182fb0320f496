// Erasing and programming of the flash (RM0090, chapter "Embedded Flash memory interface").
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct FlashProgramming {
  struct KEYR : Register<base + 0x04> {};
  struct SR : Register<base + 0x0C> {
    using BSY = Field<SR, 16, 1>;
    static constexpr std::uint32_t all_errors = 0xF2;  // OPERR, WRPERR, PGAERR, PGPERR, PGSERR; writing 1 clears them
  };
  struct CR : Register<base + 0x10> {
    using PG = Field<CR, 0, 1>;
    using SER = Field<CR, 1, 1>;
    using SNB = Field<CR, 3, 4>;
    using PSIZE = Field<CR, 8, 2>;
    using STRT = Field<CR, 16, 1>;
    using LOCK = Field<CR, 31, 1>;
  };
};

}  // namespace inkwell::registers
