// Typical control load: six PWM channels at 60 kHz, three converters at 20 kHz, and a sleeping main loop. The interrupt
// has about 2500 instructions with 120 register accesses. Measures the speed of the virtual chip.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

using namespace timer;
float state[64];

void set_up_bridge_timer(std::uint32_t t) {
  word(t + arr) = 1400;
  word(t + rcr) = 5;
  word(t + ccmr1) = 0x6868;
  word(t + ccmr2) = 0x0068;
  word(t + ccer) = 0x0111;
  word(t + ccr1) = 500;
  word(t + ccr2) = 700;
  word(t + ccr3) = 900;
  word(t + bdtr) = 1u << 15;
  word(t + cr1) = 1u << 5 | 1u << 7;
  word(t + egr) = 1;
}

void control() {
  for (unsigned i = 0; i < 3; ++i) {
    const std::uint32_t converter = adc::adc1 + 0x100 * i;
    state[i] = static_cast<float>(word(converter + adc::jdr1));
  }
  for (unsigned i = 0; i < 30; ++i)
    results[4] = results[4] + word(tim3 + cnt) + word(tim1 + cnt) + (word(gpio::b + gpio::idr) & 1);
  for (unsigned round = 0; round < 10; ++round)
    for (unsigned i = 3; i < 34; ++i) state[i] = state[i] * 0.99f + state[i - 3] * 0.01f;
  const auto duty = static_cast<std::uint32_t>(200 + (results[1] & 0x3FF));
  for (unsigned i = 0; i < 3; ++i) {
    word(tim1 + ccr1 + 4 * i) = duty;
    word(tim8 + ccr1 + 4 * i) = 1400 - duty;
  }
  word(adc::adc1 + adc::sr) = 0;
  word(adc::adc2 + adc::sr) = 0;
  word(adc::adc3 + adc::sr) = 0;
  results[1] = results[1] + 1;
}

}  // namespace

void run() {
  run_at_168_MHz();
  word(rcc::ahb1enr) |= 7;
  word(rcc::apb1enr) |= 2;
  word(rcc::apb2enr) |= 3 | 7 << 8;
  for (unsigned pin = 8; pin < 11; ++pin) gpio::alternate(gpio::a, pin, 1);
  for (unsigned pin = 6; pin < 9; ++pin) gpio::alternate(gpio::c, pin, 3);
  word(gpio::c + gpio::moder) |= 0x3F;  // C0 to C2 analog
  set_up_bridge_timer(tim1);
  set_up_bridge_timer(tim8);
  word(tim1 + cr2) = 2 << 4;
  word(tim3 + cr1) = 1;
  word(adc::ccr) = 1 << 16 | 0x15;
  for (unsigned i = 0; i < 3; ++i) {
    const std::uint32_t converter = adc::adc1 + 0x100 * i;
    word(converter + adc::jsqr) = (10 + i) << 15;
    word(converter + adc::cr2) = 1;
  }
  word(adc::adc1 + adc::cr2) = 1 | 1 << 16 | 1 << 20;
  word(adc::adc1 + adc::cr1) = 1 << 7;
  set_handler(interrupt(18), control);
  enable_interrupt(18, 0);
  word(tim8 + smcr) = 6;
  word(tim1 + cr1) |= 1;
  word(tim8 + cr1) |= 1;
  for (;;) {
    wait_for_interrupt();
    for (unsigned i = 0; i < 60; ++i) results[2] = results[2] + 1;
  }
}
