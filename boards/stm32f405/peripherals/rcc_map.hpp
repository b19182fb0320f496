// Registers of reset and clock control (RM0090, RCC_CR to RCC_PLLI2SCFGR).
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

struct RccRegisters {
  struct : Register {
    Field hsion{"HSION", 0}, hsirdy{"HSIRDY", 1, 1, Access::r}, hsitrim{"HSITRIM", 3, 5},
        hsical{"HSICAL", 8, 8, Access::r}, hseon{"HSEON", 16}, hserdy{"HSERDY", 17, 1, Access::r}, hsebyp{"HSEBYP", 18},
        csson{"CSSON", 19}, pllon{"PLLON", 24}, pllrdy{"PLLRDY", 25, 1, Access::r}, plli2son{"PLLI2SON", 26},
        plli2srdy{"PLLI2SRDY", 27, 1, Access::r};
  } cr{{"CR", 0x00, 0x83}};
  struct : Register {
    Field pllm{"PLLM", 0, 6}, plln{"PLLN", 6, 9}, pllp{"PLLP", 16, 2}, pllsrc{"PLLSRC", 22}, pllq{"PLLQ", 24, 4};
  } pllcfgr{{"PLLCFGR", 0x04, 0x2400'3010}};
  struct : Register {
    Field sw{"SW", 0, 2}, sws{"SWS", 2, 2, Access::r}, hpre{"HPRE", 4, 4}, ppre1{"PPRE1", 10, 3}, ppre2{"PPRE2", 13, 3},
        rtcpre{"RTCPRE", 16, 5}, mco1{"MCO1", 21, 2}, i2ssrc{"I2SSRC", 23}, mco1pre{"MCO1PRE", 24, 3},
        mco2pre{"MCO2PRE", 27, 3}, mco2{"MCO2", 30, 2};
  } cfgr{{"CFGR", 0x08}};
  struct : Register {
    Field lsirdyie{"LSIRDYIE", 8}, lserdyie{"LSERDYIE", 9}, hsirdyie{"HSIRDYIE", 10}, hserdyie{"HSERDYIE", 11},
        pllrdyie{"PLLRDYIE", 12}, plli2srdyie{"PLLI2SRDYIE", 13}, cssf{"CSSF", 7, 1, Access::r},
        cssc{"CSSC", 23, 1, Access::w};
  } cir{{"CIR", 0x0C}};
  /// Each bit of a reset register resets one peripheral. The same bit of the register at offset + 0x20 enables the
  /// peripheral's clock.
  Register ahb1rstr{"AHB1RSTR", 0x10}, ahb2rstr{"AHB2RSTR", 0x14}, ahb3rstr{"AHB3RSTR", 0x18},
      apb1rstr{"APB1RSTR", 0x20}, apb2rstr{"APB2RSTR", 0x24};
  struct : Register {
    Field gpioen{"GPIO#EN", 0, 1, Access::rw, {9, 1, 'A'}}, crcen{"CRCEN", 12}, bkpsramen{"BKPSRAMEN", 18},
        ccmdataramen{"CCMDATARAMEN", 20}, dmaen{"DMA#EN", 21, 1, Access::rw, {2, 1, 1}}, ethmacen{"ETHMACEN", 25},
        otghsen{"OTGHSEN", 29};
  } ahb1enr{{"AHB1ENR", 0x30, 0x0010'0000}};
  struct : Register {
    Field dcmien{"DCMIEN", 0}, rngen{"RNGEN", 6}, otgfsen{"OTGFSEN", 7};
  } ahb2enr{{"AHB2ENR", 0x34}};
  Register ahb3enr{"AHB3ENR", 0x38};
  struct : Register {
    Field tim2en{"TIM2EN", 0}, tim3en{"TIM3EN", 1}, tim4en{"TIM4EN", 2}, tim5en{"TIM5EN", 3}, tim6en{"TIM6EN", 4},
        tim7en{"TIM7EN", 5}, tim12en{"TIM12EN", 6}, tim13en{"TIM13EN", 7}, tim14en{"TIM14EN", 8}, wwdgen{"WWDGEN", 11},
        spi2en{"SPI2EN", 14}, spi3en{"SPI3EN", 15}, usart2en{"USART2EN", 17}, usart3en{"USART3EN", 18},
        uart4en{"UART4EN", 19}, uart5en{"UART5EN", 20}, i2cen{"I2C#EN", 21, 1, Access::rw, {3, 1, 1}},
        canen{"CAN#EN", 25, 1, Access::rw, {2, 1, 1}}, pwren{"PWREN", 28}, dacen{"DACEN", 29};
  } apb1enr{{"APB1ENR", 0x40}};
  struct : Register {
    Field tim1en{"TIM1EN", 0}, tim8en{"TIM8EN", 1}, usart1en{"USART1EN", 4}, usart6en{"USART6EN", 5},
        adcen{"ADC#EN", 8, 1, Access::rw, {3, 1, 1}}, sdioen{"SDIOEN", 11}, spi1en{"SPI1EN", 12},
        syscfgen{"SYSCFGEN", 14}, tim9en{"TIM9EN", 16}, tim10en{"TIM10EN", 17}, tim11en{"TIM11EN", 18};
  } apb2enr{{"APB2ENR", 0x44}};
  struct : Register {
    Field lseon{"LSEON", 0}, lserdy{"LSERDY", 1, 1, Access::r}, lsebyp{"LSEBYP", 2}, rtcsel{"RTCSEL", 8, 2},
        rtcen{"RTCEN", 15}, bdrst{"BDRST", 16};
  } bdcr{{"BDCR", 0x70}};
  struct : Register {
    Field lsion{"LSION", 0}, lsirdy{"LSIRDY", 1, 1, Access::r}, rmvf{"RMVF", 24, 1, Access::rs},
        borrstf{"BORRSTF", 25, 1, Access::r}, pinrstf{"PINRSTF", 26, 1, Access::r},
        porrstf{"PORRSTF", 27, 1, Access::r}, sftrstf{"SFTRSTF", 28, 1, Access::r},
        iwdgrstf{"IWDGRSTF", 29, 1, Access::r}, wwdgrstf{"WWDGRSTF", 30, 1, Access::r},
        lpwrrstf{"LPWRRSTF", 31, 1, Access::r};
  } csr{{"CSR", 0x74, 0x0E00'0000}};
  struct : Register {
    Field plli2sn{"PLLI2SN", 6, 9}, plli2sr{"PLLI2SR", 28, 3};
  } plli2scfgr{{"PLLI2SCFGR", 0x84, 0x2000'3000}};
};
inline constexpr RccRegisters rcc_map;

}  // namespace inkwell::virtual_board
