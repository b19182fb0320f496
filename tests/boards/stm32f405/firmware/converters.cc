// TIM2's trigger output starts an injected conversion of ADC1 to ADC3 every 20 us. Meanwhile ADC1 converts two channels
// continuously and stores them by DMA, with half-transfer and transfer-complete interrupts.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {
std::uint16_t ring[8];
void converted() {
  results[2] = word(adc::adc1 + adc::jdr1);
  results[3] = word(adc::adc2 + adc::jdr1);
  results[4] = word(adc::adc3 + adc::jdr1);
  results[5] = word(timer::tim2 + timer::cnt);
  for (unsigned i = 0; i < 3; ++i) word(adc::adc1 + 0x100 * i + adc::sr) = ~0xCu;
  results[1] = results[1] + 1;
}
void ring_filled() {
  word(gpio::b + gpio::odr) = word(gpio::b + gpio::odr) ^ 1 << 2;
  word(0x40026408 + 4) = 0x3Du;  // HIFCR, stream 4
  results[6] = results[6] + 1;
  for (unsigned i = 0; i < 4; ++i) results[8 + i] = ring[2 * i] | static_cast<std::uint32_t>(ring[2 * i + 1]) << 16;
}
}  // namespace

void run() {
  run_at_168_MHz();
  word(rcc::ahb1enr) |= 7 | 1 << 22;
  word(rcc::apb1enr) |= 1;
  word(rcc::apb2enr) |= 7 << 8;
  word(gpio::c + gpio::moder) = 0x3FF;    // C0 to C4 analog
  word(gpio::b + gpio::moder) |= 1 << 4;  // B2 an output
  word(adc::ccr) = 1 << 16 | 0x15;        // PCLK2 / 4, injected simultaneous, three converters
  for (unsigned i = 0; i < 3; ++i) {
    word(adc::adc1 + 0x100 * i + adc::jsqr) = (10 + i) << 15;
    word(adc::adc1 + 0x100 * i + adc::cr2) = 1;
  }
  start_cycle_counter();
  while (cycles() < 3 * 168) {  // stabilization time of the converters
  }
  // Stream 4, channel 0: 16 bits, memory increment, circular, half-transfer and transfer-complete interrupts.
  word(0x40026410 + 0x18 * 4 + 0x8) = adc::adc1 + adc::dr;
  word(0x40026410 + 0x18 * 4 + 0xC) = reinterpret_cast<std::uint32_t>(ring);
  word(0x40026410 + 0x18 * 4 + 0x4) = 8;
  word(0x40026410 + 0x18 * 4) = 1 << 13 | 1 << 11 | 1 << 10 | 1 << 8 | 1 << 4 | 1;
  set_handler(interrupt(60), ring_filled);
  enable_interrupt(60, 5);
  word(adc::adc1 + adc::sqr1) = 1 << 20;
  word(adc::adc1 + adc::sqr3) = 13 | 14 << 5;
  word(adc::adc1 + adc::smpr1) = 4 << 9 | 4 << 12;  // channels 13 and 14: 84 cycles
  word(adc::adc1 + adc::cr1) = 1 << 7 | 1 << 8;
  set_handler(interrupt(18), converted);
  enable_interrupt(18, 1);
  word(adc::adc1 + adc::cr2) = 1 | 1 << 1 | 1 << 8 | 1 << 9 | 3 << 16 | 1 << 20;
  word(adc::adc1 + adc::cr2) = word(adc::adc1 + adc::cr2) | 1u << 30;
  word(timer::tim2 + timer::arr) = 84 * 20 - 1;  // 84 MHz
  word(timer::tim2 + timer::cr2) = 2 << 4;
  word(timer::tim2 + timer::cr1) = 1;
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
