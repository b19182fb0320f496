// TIM1 starts TIM8. Both timers are center-aligned with known compare values; the update occurs every sixth half
// period.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {
using namespace timer;
void set_up(std::uint32_t t, std::uint32_t compare) {
  word(t + arr) = 1000;
  word(t + rcr) = 5;
  word(t + ccmr1) = 0x0068;
  word(t + ccer) = 1;
  word(t + ccr1) = compare;
  word(t + bdtr) = 1u << 15;
  word(t + cr1) = 1u << 5 | 1u << 7;
  word(t + egr) = 1;
  word(t + sr) = 0;
}
void update() {
  word(tim1 + sr) = ~1u;
  const std::uint32_t n = results[1];
  if (n < 4) {
    results[4 + 2 * n] = word(tim1 + cr1) >> 4 & 1;  // counting direction after the update
    results[5 + 2 * n] = word(tim1 + cnt);
  }
  results[1] = n + 1;
  if (n == 9) word(tim1 + ccr1) = 250;  // preloaded: becomes active at the next update
}
}  // namespace

void run() {
  run_at_168_MHz();
  word(rcc::ahb1enr) |= 7;
  word(rcc::apb2enr) |= 3;
  gpio::alternate(gpio::a, 8, 1);
  gpio::alternate(gpio::c, 6, 3);
  set_up(tim1, 400);
  set_up(tim8, 600);
  word(tim1 + cr2) = 1 << 4;  // TRGO: enable
  word(tim8 + smcr) = 6;      // trigger mode, ITR0 is TIM1
  set_handler(interrupt(25), update);
  enable_interrupt(25, 1);
  word(tim1 + dier) = 1;
  results[0] = finished;
  word(tim1 + cr1) |= 1;
  while (results[1] < 2) wait_for_interrupt();
  results[2] = word(tim1 + cnt) - word(tim8 + cnt);
  for (;;) wait_for_interrupt();
}
