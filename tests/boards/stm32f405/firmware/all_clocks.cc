// Enables the clocks of all modeled peripherals and does not write to the peripherals.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {
constexpr std::uint32_t ahb2enr = 0x40023834;
constexpr std::uint32_t gpio_a_to_i = 0x1FF, crc = 1 << 12, dma = 3 << 21;
constexpr std::uint32_t rng = 1 << 6;
constexpr std::uint32_t tim2_to_7_and_12_to_14 = 0x1FF, wwdg = 1 << 11, spi2_and_3 = 3 << 14, usart2_to_5 = 0xF << 17,
                        i2c = 7 << 21, can = 3 << 25, pwr_and_dac = 3 << 28;
constexpr std::uint32_t tim1_and_8 = 3, usart1_and_6 = 3 << 4, adc1_to_3 = 7 << 8, spi1 = 1 << 12, syscfg = 1 << 14,
                        tim9_to_11 = 7 << 16;
}  // namespace

void run() {
  word(rcc::ahb1enr) |= gpio_a_to_i | crc | dma;
  word(ahb2enr) |= rng;
  word(rcc::apb1enr) |= tim2_to_7_and_12_to_14 | wwdg | spi2_and_3 | usart2_to_5 | i2c | can | pwr_and_dac;
  word(rcc::apb2enr) |= tim1_and_8 | usart1_and_6 | adc1_to_3 | spi1 | syscfg | tim9_to_11;
  for (unsigned i = 0; i < 10; ++i) results[1] = word(rcc::apb2enr);  // waits until the clocks have started
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
