// General-purpose input and output (RM0090, chapter GPIO). The pin driver defines the fields of a pin.
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct GeneralPurposeIo {
  struct MODER : Register<base + 0x00> {};
  struct OSPEEDR : Register<base + 0x08> {};
  struct PUPDR : Register<base + 0x0C> {};
  struct IDR : Register<base + 0x10> {};
  struct BSRR : Register<base + 0x18> {};
  struct AFRL : Register<base + 0x20> {};
  struct AFRH : Register<base + 0x24> {};
};

}  // namespace inkwell::registers
