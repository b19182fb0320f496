// TIM3 counts both edges of both inputs, B4 and B5, with pull-ups.
#include "tests/boards/stm32f405/firmware/support.hpp"

void run() {
  using namespace timer;
  word(rcc::ahb1enr) |= 2;
  word(rcc::apb1enr) |= 2;
  word(gpio::b + gpio::pupdr) = 1 << 8 | 1 << 10;
  gpio::alternate(gpio::b, 4, 2);
  gpio::alternate(gpio::b, 5, 2);
  word(tim3 + ccmr1) = 0x0101;
  word(tim3 + smcr) = 3;
  word(tim3 + arr) = 0xFFFF;
  word(tim3 + cnt) = 0;
  word(tim3 + cr1) = 1;
  results[0] = finished;
  for (;;) {
    results[1] = word(tim3 + cnt);
    results[2] = word(tim3 + cr1) >> 4 & 1;
  }
}
