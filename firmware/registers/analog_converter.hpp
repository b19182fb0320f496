// Analog-to-digital converters and their common registers (RM0090, chapter ADC).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct AnalogConverter {
  struct SR : Register<base + 0x00> {
    using EOC = Field<SR, 1, 1>;
    using JEOC = Field<SR, 2, 1>;
    using JSTRT = Field<SR, 3, 1>;
    using OVR = Field<SR, 5, 1>;
  };
  struct CR1 : Register<base + 0x04> {
    using JEOCIE = Field<CR1, 7, 1>;
    using SCAN = Field<CR1, 8, 1>;
  };
  struct CR2 : Register<base + 0x08> {
    using ADON = Field<CR2, 0, 1>;
    using DMA = Field<CR2, 8, 1>;
    using DDS = Field<CR2, 9, 1>;
    using JEXTSEL = Field<CR2, 16, 4>;
    using JEXTEN = Field<CR2, 20, 2>;
    using SWSTART = Field<CR2, 30, 1>;
  };
  struct SMPR1 : Register<base + 0x0C> {};
  struct SMPR2 : Register<base + 0x10> {};
  struct SQR1 : Register<base + 0x2C> {
    using L = Field<SQR1, 20, 4>;
  };
  struct SQR3 : Register<base + 0x34> {
    using SQ1 = Field<SQR3, 0, 5>;
    using SQ2 = Field<SQR3, 5, 5>;
    using SQ3 = Field<SQR3, 10, 5>;
    using SQ4 = Field<SQR3, 15, 5>;
    using SQ5 = Field<SQR3, 20, 5>;
  };
  struct JSQR : Register<base + 0x38> {
    using JSQ4 = Field<JSQR, 15, 5>;
    using JL = Field<JSQR, 20, 2>;
  };
  struct JDR1 : Register<base + 0x3C> {
    using JDATA = Field<JDR1, 0, 16>;
  };
  struct DR : Register<base + 0x4C> {};
};

template <std::uint32_t base>
struct AnalogConverterCommon {
  struct CCR : Register<base + 0x04> {
    using ADCPRE = Field<CCR, 16, 2>;
    using TSVREFE = Field<CCR, 23, 1>;
  };
};

}  // namespace inkwell::registers
