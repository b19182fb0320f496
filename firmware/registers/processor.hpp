// Registers of the Cortex-M4F core (ARMv7-M Architecture Reference Manual, PM0214). Debug configuration and unique
// identifier of the chip (RM0090, chapters Debug support and Device electronic signature).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct SystemControlBlock {
  struct ICSR : Register<base + 0x04> {
    using PENDSVSET = Field<ICSR, 28, 1>;
  };
  struct VTOR : Register<base + 0x08> {};
  struct AIRCR : Register<base + 0x0C> {
    using SYSRESETREQ = Field<AIRCR, 2, 1>;
    using VECTKEY = Field<AIRCR, 16, 16>;
  };
  struct SHPR3 : Register<base + 0x20> {
    using PRI_14 = Field<SHPR3, 16, 8>;
  };
  struct SHCSR : Register<base + 0x24> {
    using MEMFAULTENA = Field<SHCSR, 16, 1>;
    using BUSFAULTENA = Field<SHCSR, 17, 1>;
    using USGFAULTENA = Field<SHCSR, 18, 1>;
  };
  struct CFSR : Register<base + 0x28> {
    using MMARVALID = Field<CFSR, 7, 1>;
  };
  struct HFSR : Register<base + 0x2C> {};
  struct MMFAR : Register<base + 0x34> {};
  struct BFAR : Register<base + 0x38> {};
};

template <std::uint32_t base>
struct MemoryProtectionUnit {
  struct CTRL : Register<base + 0x04> {
    using ENABLE = Field<CTRL, 0, 1>;
    using PRIVDEFENA = Field<CTRL, 2, 1>;
  };
  struct RNR : Register<base + 0x08> {
    using REGION = Field<RNR, 0, 8>;
  };
  struct RBAR : Register<base + 0x0C> {};
  struct RASR : Register<base + 0x10> {
    using ENABLE = Field<RASR, 0, 1>;
    using SIZE = Field<RASR, 1, 5>;
    using SRD = Field<RASR, 8, 8>;
    using C = Field<RASR, 17, 1>;
    using S = Field<RASR, 18, 1>;
    using AP = Field<RASR, 24, 3>;
    using XN = Field<RASR, 28, 1>;
  };
};

template <std::uint32_t base>
struct CoprocessorAccess {
  struct CPACR : Register<base + 0x00> {
    using CP = Field<CPACR, 20, 4>;
  };
};

template <std::uint32_t base>
struct NestedVectoredInterruptController {
  struct ISER : RegisterArray<base + 0x000, 4, 3> {};
  struct IPR : RegisterArray<base + 0x300, 1, 82, std::uint8_t> {};
};

template <std::uint32_t base>
struct CoreDebug {
  struct DEMCR : Register<base + 0x0C> {
    using TRCENA = Field<DEMCR, 24, 1>;
  };
};

template <std::uint32_t base>
struct DataWatchpointAndTrace {
  struct CTRL : Register<base + 0x00> {
    using CYCCNTENA = Field<CTRL, 0, 1>;
  };
  struct CYCCNT : Register<base + 0x04> {};
};

template <std::uint32_t base>
struct DebugSupport {
  struct DBGMCU_APB1_FZ : Register<base + 0x08> {
    using DBG_IWDG_STOP = Field<DBGMCU_APB1_FZ, 12, 1>;
  };
  struct DBGMCU_APB2_FZ : Register<base + 0x0C> {
    using DBG_TIM1_STOP = Field<DBGMCU_APB2_FZ, 0, 1>;
    using DBG_TIM8_STOP = Field<DBGMCU_APB2_FZ, 1, 1>;
  };
};

template <std::uint32_t base>
struct DeviceSignature {
  struct U_ID : RegisterArray<base + 0x00, 4, 3> {};
  struct VREFIN_CAL : Register<base + 0x1A, std::uint16_t> {};
};

}  // namespace inkwell::registers
