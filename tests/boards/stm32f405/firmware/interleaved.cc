// Three interleaved converters sample one pin. One DMA stream stores the results until the transfer is complete.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

void convert(std::uint32_t sampling_code, std::uint32_t items, volatile std::uint32_t* to) {
  for (unsigned i = 0; i < 3; ++i) {
    const std::uint32_t converter = adc::adc1 + 0x100 * i;
    word(converter + adc::cr2) = 0;
    word(converter + adc::sr) = 0;
    word(converter + 0x0C) = sampling_code;  // SMPR1: channel 10
    word(converter + adc::sqr3) = 10;
    word(converter + adc::cr2) = 1 | 1 << 1;
  }
  adc::collect_common_data(2, items, to);
  word(adc::ccr) = 1 << 16 | 2 << 14 | 0x17;
  for (unsigned i = 0; i < 100; ++i) asm volatile("nop");
  word(adc::adc1 + adc::cr2) |= 1u << 30;
  adc::wait_for_items();
}

}  // namespace

void run() {
  word(rcc::ahb1enr) |= 1 << 22 | 1 << 2;
  word(rcc::apb2enr) |= 7 << 8;
  word(gpio::c + gpio::moder) = 3;
  convert(0, 6, results + 1);
  while ((word(adc::adc1 + adc::sr) & 1 << 5) == 0) {
  }
  results[7] = adc::items_left();
  results[8] = 1;  // start of the second run
  convert(1, 3, results + 9);
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
