// Advanced-control timers and general-purpose timers with encoder interface (RM0090, chapters TIM1 and TIM8,
// TIM2 to TIM5).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct AdvancedTimer {
  struct CR1 : Register<base + 0x00> {
    using CEN = Field<CR1, 0, 1>;
    using URS = Field<CR1, 2, 1>;
    using DIR = Field<CR1, 4, 1>;
    using CMS = Field<CR1, 5, 2>;
    using ARPE = Field<CR1, 7, 1>;
  };
  struct CR2 : Register<base + 0x04> {
    using MMS = Field<CR2, 4, 3>;
  };
  struct SMCR : Register<base + 0x08> {
    using SMS = Field<SMCR, 0, 3>;
    using TS = Field<SMCR, 4, 3>;
  };
  struct SR : Register<base + 0x10> {
    using UIF = Field<SR, 0, 1>;
    using BIF = Field<SR, 7, 1>;
  };
  struct EGR : Register<base + 0x14> {
    using UG = Field<EGR, 0, 1>;
  };
  struct CCMR1 : Register<base + 0x18> {
    using OC1PE = Field<CCMR1, 3, 1>;
    using OC1M = Field<CCMR1, 4, 3>;
    using OC2PE = Field<CCMR1, 11, 1>;
    using OC2M = Field<CCMR1, 12, 3>;
  };
  struct CCMR2 : Register<base + 0x1C> {
    using OC3PE = Field<CCMR2, 3, 1>;
    using OC3M = Field<CCMR2, 4, 3>;
  };
  struct CCER : Register<base + 0x20> {
    using CC1E = Field<CCER, 0, 1>;
    using CC2E = Field<CCER, 4, 1>;
    using CC3E = Field<CCER, 8, 1>;
  };
  struct CNT : Register<base + 0x24> {};
  struct PSC : Register<base + 0x28> {};
  struct ARR : Register<base + 0x2C> {};
  struct RCR : Register<base + 0x30> {
    using REP = Field<RCR, 0, 8>;
  };
  struct CCR : RegisterArray<base + 0x34, 4, 4> {};
  struct BDTR : Register<base + 0x44> {
    using LOCK = Field<BDTR, 8, 2>;
    using OSSI = Field<BDTR, 10, 1>;
    using OSSR = Field<BDTR, 11, 1>;
    using BKE = Field<BDTR, 12, 1>;
    using MOE = Field<BDTR, 15, 1>;
  };
};

template <std::uint32_t base>
struct EncoderTimer {
  struct CR1 : Register<base + 0x00> {
    using CEN = Field<CR1, 0, 1>;
  };
  struct SMCR : Register<base + 0x08> {
    using SMS = Field<SMCR, 0, 3>;
  };
  struct CCMR1 : Register<base + 0x18> {
    using CC1S = Field<CCMR1, 0, 2>;
    using IC1F = Field<CCMR1, 4, 4>;
    using CC2S = Field<CCMR1, 8, 2>;
    using IC2F = Field<CCMR1, 12, 4>;
  };
  struct CNT : Register<base + 0x24> {};
  struct ARR : Register<base + 0x2C> {};
};

/// Timer with a capture register.
template <std::uint32_t base>
struct CaptureTimer {
  struct CR1 : Register<base + 0x00> {
    using CEN = Field<CR1, 0, 1>;
  };
  struct SMCR : Register<base + 0x08> {
    using TS = Field<SMCR, 4, 3>;
  };
  struct SR : Register<base + 0x10> {
    using CC1IF = Field<SR, 1, 1>;
  };
  struct CCMR1 : Register<base + 0x18> {
    using CC1S = Field<CCMR1, 0, 2>;
  };
  struct CCER : Register<base + 0x20> {
    using CC1E = Field<CCER, 0, 1>;
  };
  struct CNT : Register<base + 0x24> {};
  struct ARR : Register<base + 0x2C> {};
  struct CCR1 : Register<base + 0x34> {};
  struct OR : Register<base + 0x50> {
    using ITR1_RMP = Field<OR, 10, 2>;
  };
};

}  // namespace inkwell::registers
