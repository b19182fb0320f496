// Three converters run simultaneously. One DMA stream reads the common data register in each of the three DMA modes.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

/// Starts two conversions of each converter with one command; the DMA stream writes them to `to`.
void convert(std::uint32_t mode, std::uint32_t size, std::uint32_t items, volatile std::uint32_t* to) {
  adc::collect_common_data(size, items, to);
  word(adc::ccr) = 1 << 16 | mode << 14 | 0x16;  // regular simultaneous, all three
  for (unsigned i = 0; i < 3; ++i) word(adc::adc1 + 0x100 * i + adc::sr) = 0;
  word(adc::adc1 + adc::cr2) |= 1u << 30;
  adc::wait_for_items();
}

}  // namespace

void run() {
  word(rcc::ahb1enr) |= 1 << 22 | 1 << 2;
  word(rcc::apb2enr) |= 7 << 8;
  word(gpio::c + gpio::moder) = 0x3F;
  for (unsigned i = 0; i < 3; ++i) {
    const std::uint32_t converter = adc::adc1 + 0x100 * i;
    word(converter + adc::cr1) = 1 << 8;
    word(converter + adc::sqr1) = 1 << 20;
    word(converter + adc::sqr3) = (10 + i) | (10 + i) << 5;
    word(converter + adc::cr2) = 1;
  }
  for (unsigned i = 0; i < 100; ++i) asm volatile("nop");
  convert(1, 1, 6, results + 1);
  convert(2, 2, 3, results + 4);
  convert(3, 1, 3, results + 7);
  results[9] = adc::items_left();
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
