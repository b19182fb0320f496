// Reset and clock control, power control, boot mode, interrupt lines, flash interface (RM0090, chapters RCC, PWR,
// SYSCFG, EXTI, Embedded flash).
#pragma once

#include "firmware/registers/register.hpp"

namespace inkwell::registers {

template <std::uint32_t base>
struct ResetAndClockControl {
  struct CR : Register<base + 0x00> {
    using HSION = Field<CR, 0, 1>;
    using HSIRDY = Field<CR, 1, 1>;
    using HSEON = Field<CR, 16, 1>;
    using HSERDY = Field<CR, 17, 1>;
    using CSSON = Field<CR, 19, 1>;
    using PLLON = Field<CR, 24, 1>;
    using PLLRDY = Field<CR, 25, 1>;
  };
  struct PLLCFGR : Register<base + 0x04> {
    using PLLM = Field<PLLCFGR, 0, 6>;
    using PLLN = Field<PLLCFGR, 6, 9>;
    using PLLP = Field<PLLCFGR, 16, 2>;
    using PLLSRC = Field<PLLCFGR, 22, 1>;
    using PLLQ = Field<PLLCFGR, 24, 4>;
  };
  struct CFGR : Register<base + 0x08> {
    using SW = Field<CFGR, 0, 2>;
    using SWS = Field<CFGR, 2, 2>;
    using PPRE1 = Field<CFGR, 10, 3>;
    using PPRE2 = Field<CFGR, 13, 3>;
  };
  struct AHB1ENR : Register<base + 0x30> {
    using GPIOAEN = Field<AHB1ENR, 0, 1>;
    using GPIOBEN = Field<AHB1ENR, 1, 1>;
    using GPIOCEN = Field<AHB1ENR, 2, 1>;
    using CRCEN = Field<AHB1ENR, 12, 1>;
    using CCMDATARAMEN = Field<AHB1ENR, 20, 1>;
    using DMA2EN = Field<AHB1ENR, 22, 1>;
  };
  struct AHB2ENR : Register<base + 0x34> {
    using OTGFSEN = Field<AHB2ENR, 7, 1>;
  };
  struct APB1ENR : Register<base + 0x40> {
    using TIM2EN = Field<APB1ENR, 0, 1>;
    using TIM3EN = Field<APB1ENR, 1, 1>;
    using TIM4EN = Field<APB1ENR, 2, 1>;
    using TIM5EN = Field<APB1ENR, 3, 1>;
    using USART2EN = Field<APB1ENR, 17, 1>;
    using PWREN = Field<APB1ENR, 28, 1>;
  };
  struct APB2ENR : Register<base + 0x44> {
    using TIM1EN = Field<APB2ENR, 0, 1>;
    using TIM8EN = Field<APB2ENR, 1, 1>;
    using ADC1EN = Field<APB2ENR, 8, 1>;
    using ADC2EN = Field<APB2ENR, 9, 1>;
    using ADC3EN = Field<APB2ENR, 10, 1>;
    using SYSCFGEN = Field<APB2ENR, 14, 1>;
  };
  struct CSR : Register<base + 0x74> {
    using RMVF = Field<CSR, 24, 1>;
    using BORRSTF = Field<CSR, 25, 1>;
    using PORRSTF = Field<CSR, 27, 1>;
    using IWDGRSTF = Field<CSR, 29, 1>;
  };
};

template <std::uint32_t base>
struct PowerControl {
  struct CR : Register<base + 0x00> {
    using PVDE = Field<CR, 4, 1>;
    using PLS = Field<CR, 5, 3>;
    using VOS = Field<CR, 14, 1>;
  };
  struct CSR : Register<base + 0x04> {
    using PVDO = Field<CSR, 2, 1>;
  };
};

template <std::uint32_t base>
struct SystemConfiguration {
  struct MEMRMP : Register<base + 0x00> {
    using MEM_MODE = Field<MEMRMP, 0, 2>;
  };
};

template <std::uint32_t base>
struct InterruptLines {
  struct IMR : Register<base + 0x00> {};
  struct RTSR : Register<base + 0x08> {};
  struct PR : Register<base + 0x14> {};
};

template <std::uint32_t base>
struct FlashInterface {
  struct ACR : Register<base + 0x00> {
    using LATENCY = Field<ACR, 0, 3>;
    using PRFTEN = Field<ACR, 8, 1>;
    using ICEN = Field<ACR, 9, 1>;
    using DCEN = Field<ACR, 10, 1>;
    using DCRST = Field<ACR, 12, 1>;
  };
};

}  // namespace inkwell::registers
