// TIM1's break input, A6, is active low. The break input sets the outputs to their idle level, low, without the CPU.
#include "tests/boards/stm32f405/firmware/support.hpp"

void run() {
  using namespace timer;
  run_at_168_MHz();
  word(rcc::ahb1enr) |= 1;
  word(rcc::apb2enr) |= 1;
  gpio::alternate(gpio::a, 6, 1);
  gpio::alternate(gpio::a, 8, 1);
  word(tim1 + arr) = 1000;
  word(tim1 + ccmr1) = 0x0068;
  word(tim1 + ccer) = 1;
  word(tim1 + ccr1) = 400;
  word(tim1 + bdtr) = 1u << 15 | 1u << 12 | 1u << 10;  // MOE, BKE, OSSI
  word(tim1 + cr1) = 1u << 5 | 1u;
  word(tim1 + egr) = 1;
  word(tim1 + sr) = 0;
  results[0] = finished;
  for (;;) {
    results[1] = word(tim1 + sr) >> 7 & 1;
    results[2] = word(tim1 + bdtr) >> 15 & 1;
    if ((word(gpio::a + gpio::idr) & 1) == 0) continue;  // a high level at A0 enables the outputs again
    word(tim1 + sr) = ~(1u << 7);
    word(tim1 + bdtr) |= 1u << 15;
  }
}
