// Pins, external interrupts, bit-banding, unique ID, USART and flash programming at 168 MHz.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {
void edge() {
  word(0x40013C14) = 1u << 13;
  results[1] = results[1] + 1;
}
constexpr std::uint32_t usart2 = 0x40004400, flash = 0x40023C00;
}  // namespace

void run() {
  run_at_168_MHz();
  word(rcc::ahb1enr) |= 7;
  word(rcc::apb1enr) |= 1 << 17;
  word(rcc::apb2enr) |= 1 << 14;

  // A falling edge on B13 triggers EXTI line 13.
  word(gpio::b + gpio::pupdr) = 1 << 26;
  word(0x40013800 + 0x14) = 1 << 4;
  word(0x40013C0C) = 1 << 13;
  word(0x40013C00) = 1 << 13;
  set_handler(interrupt(40), edge);
  enable_interrupt(40, 2);

  // Sets C10 through the bit-band alias of GPIOC_ODR, and an SRAM bit through its alias.
  word(gpio::c + gpio::moder) = 1 << 20;
  word(0x42000000 + (gpio::c + gpio::odr - 0x40000000) * 32 + 10 * 4) = 1;
  results[20] = 0;
  word(0x22000000 + (0x2001F050 - 0x20000000) * 32 + 5 * 4) = 1;
  results[2] = results[20];
  results[3] = word(0x1FFF7A10);
  results[4] = half(0x1FFF7A22);

  // 115200 baud: 42 MHz / 365.
  gpio::alternate(gpio::a, 2, 7);
  word(usart2 + 0x08) = 365;
  word(usart2 + 0x0C) = 1 << 13 | 1 << 3 | 1 << 2;
  for (const char* text = "chip\n"; *text != 0; ++text) {
    while ((word(usart2) & 1 << 7) == 0) {
    }
    word(usart2 + 0x04) = static_cast<std::uint8_t>(*text);
  }
  start_cycle_counter();

  // Sector 2: unlock, erase, program a word.
  word(flash + 0x04) = 0x45670123;
  word(flash + 0x04) = 0xCDEF89AB;
  word(flash + 0x10) = 2 << 8 | 2 << 3 | 1 << 1;
  word(flash + 0x10) = 2 << 8 | 2 << 3 | 1 << 1 | 1 << 16;
  while ((word(flash + 0x0C) & 1 << 16) != 0)
    for (unsigned i = 0; i < 10000; ++i) asm volatile("nop");
  word(flash + 0x10) = 2 << 8 | 1;
  word(0x08008000) = 0x12345678;
  while ((word(flash + 0x0C) & 1 << 16) != 0) {
  }
  word(flash + 0x10) = 1u << 31;
  results[5] = word(0x08008000);
  word(0x08008004) = 0;  // locked: an error flag, and no programming
  asm volatile("isb" ::: "memory");
  results[6] = word(0x08008004);
  results[7] = word(flash + 0x0C);
  results[0] = finished;
  for (;;) {
    if ((word(usart2) & 1 << 5) != 0) results[8] = results[8] * 256 + word(usart2 + 0x04);
  }
}
