// Starts clocks, converter, watchdog, a locked timer and the USB core according to the manual. Port D, which is read
// first, selects the one rule that is violated.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

// The numbers match violations_test.cpp.
enum Violation : std::uint32_t {
  none,
  float_unit_off,
  voltage_scale,
  usb_clock,
  usb_pins,
  usb_transceiver,
  usb_core_reset,
  usb_mode_wait,
  usb_turnaround,
  usb_speed,
  converter_too_fast,
  converter_clock_off,
  analog_pin_mode,
  converter_not_stable,
  usb_mode,
  usb_fifo_packets,
  flash_wait_states,
  pclk1_too_fast,
  pll_input,
  clock_fresh,
  ccm_clock_off,
  timer_locked,
  watchdog_busy,
  usb_disturbed,
  option_bytes_locked,
  narrow_register_write,
  region_undefined,
  region_number,
  region_number_of_base,
  narrow_core_write,
  stream_flags_left,
  usart_pin,
  usart_divider,
  reference_off,
  reference_hurried,
  reference_hurried_on,
  core_reset,
};

std::uint32_t violation;

void read_back(std::uint32_t address) { [[maybe_unused]] const std::uint32_t value = word(address); }

void wait_us(std::uint32_t time_us) {
  start_cycle_counter();
  while (cycles() < time_us * 168) {
  }
}

void start_clocks() {
  word(rcc::apb1enr) |= 1u << 28;
  read_back(rcc::apb1enr);
  word(0x40007000) = violation == voltage_scale ? 0 : 1u << 14;
  word(0x40023C00) = (violation == flash_wait_states ? 4 : 5) | 7 << 8;
  word(rcc::cr) |= 1u << 16;
  while ((word(rcc::cr) & 1u << 17) == 0) {
  }
  const std::uint32_t q = violation == usb_clock ? 8 : 7;
  word(rcc::pllcfgr) = (violation == pll_input ? 2 | 84 << 6 : 4 | 168 << 6) | 1 << 22 | q << 24;
  word(rcc::cr) |= 1u << 24;
  while ((word(rcc::cr) & 1u << 25) == 0) {
  }
  word(rcc::cfgr) = (violation == pclk1_too_fast ? 4 : 5) << 10 | 4 << 13;
  word(rcc::cfgr) = word(rcc::cfgr) | 2;
  while ((word(rcc::cfgr) & 0xC) != 8) {
  }
}

void convert() {
  word(rcc::ahb1enr) |= 7;
  word(rcc::apb2enr) |= (violation == converter_clock_off ? 1 : 7) << 8;
  read_back(rcc::apb2enr);
  if (violation != analog_pin_mode) word(gpio::c + gpio::moder) = 0x3F;
  word(adc::ccr) = violation == converter_too_fast ? 0 : 1 << 16;
  for (unsigned i = 0; i < 3; ++i) {
    word(adc::adc1 + 0x100 * i + adc::smpr1) = 1 << 3 * i;  // 15 cycles, used for the first conversion
    word(adc::adc1 + 0x100 * i + adc::sqr3) = 10 + i;
    word(adc::adc1 + 0x100 * i + adc::cr2) = 1;
  }
  if (violation != converter_not_stable) wait_us(4);
  for (unsigned i = 0; i < 3; ++i) word(adc::adc1 + 0x100 * i + adc::cr2) = 1 | 1u << 30;
  wait_us(10);
  for (unsigned i = 0; i < 3; ++i) results[1 + i] = word(adc::adc1 + 0x100 * i + adc::dr);
}

/// Converts the internal reference with the first converter.
void convert_reference() {
  if (violation != reference_off) word(adc::ccr) |= 1 << 23;
  if (violation != reference_hurried_on) wait_us(12);
  word(adc::adc1 + adc::smpr1) = (violation == reference_hurried ? 3 : 7) << 21;  // 480 cycles
  word(adc::adc1 + adc::sqr3) = 17;
  word(adc::adc1 + adc::cr2) = 1 | 1u << 30;
  wait_us(30);
  results[8] = word(adc::adc1 + adc::dr);
}

/// Copies a word from memory to memory twice.
void copy() {
  constexpr std::uint32_t dma2 = 0x40026400, lifcr = dma2 + 0x08, s0cr = dma2 + 0x10, s0ndtr = dma2 + 0x14;
  word(rcc::ahb1enr) |= 1 << 22;
  read_back(rcc::ahb1enr);
  word(dma2 + 0x18) = reinterpret_cast<std::uint32_t>(results);
  word(dma2 + 0x1C) = reinterpret_cast<std::uint32_t>(results + 100);
  for (unsigned i = 0; i < 2; ++i) {
    word(s0ndtr) = 1;
    word(s0cr) = 2 << 13 | 2 << 11 | 2 << 6 | 1;
    if (violation != stream_flags_left) word(lifcr) = 0x3D;
  }
}

void send() {
  constexpr std::uint32_t usart2 = 0x40004400;
  word(rcc::apb1enr) |= 1 << 17;
  read_back(rcc::apb1enr);
  if (violation != usart_pin) gpio::alternate(gpio::a, 2, 7);
  word(usart2 + 0x08) = violation == usart_divider ? 15 : 16;
  word(usart2 + 0x0C) = 1 << 13 | 1 << 3;
  word(usart2 + 0x04) = 'x';
}

void use_others() {
  copy();
  send();
  constexpr std::uint32_t tim8 = timer::tim8;
  word(rcc::apb2enr) |= 2;
  read_back(rcc::apb2enr);
  word(tim8 + timer::psc) = 0;
  if (violation == narrow_register_write) byte(tim8 + timer::psc) = 3;
  results[6] = word(tim8 + timer::psc);
  word(tim8 + timer::bdtr) = 1u << 8 | 1u << 12;
  word(tim8 + timer::bdtr) = 1u << 8 | 1u << 12 | 1u << 15 | (violation == timer_locked ? 20 : 0);
  results[4] = word(tim8 + timer::bdtr) & 0xFF;

  if (violation == clock_fresh)
    asm volatile("str %1, [%0]\n str %3, [%2]" ::"r"(rcc::apb1enr), "r"(word(rcc::apb1enr) | 1),
                 "r"(timer::tim2 + timer::arr), "r"(1000)
                 : "memory");

  word(0x40003000) = 0xCCCC;
  word(0x40003000) = 0x5555;
  word(0x40003008) = 4000;
  if (violation != watchdog_busy)
    while (word(0x4000300C) != 0) {
    }
  word(0x40003000) = 0x5555;
  word(0x40003008) = 3000;

  constexpr std::uint32_t optkeyr = 0x40023C08, optcr = 0x40023C14;
  if (violation != option_bytes_locked) {
    word(optkeyr) = 0x08192A3B;
    word(optkeyr) = 0x4C5D6E7F;
  }
  word(optcr) = (word(optcr) & ~0xFu) | 1;  // brown-out level 3, not programmed yet
  results[7] = word(optcr);

  if (violation == ccm_clock_off) word(rcc::ahb1enr) &= ~(1u << 20);
  word(0x10000000) = 1;
}

// RM0090, "OTG_FS programming model".
void start_usb() {
  constexpr std::uint32_t core = 0x50000000, gusbcfg = core + 0x0C, grstctl = core + 0x10;
  word(0x40023834) |= 1u << 7;  // AHB2ENR
  read_back(0x40023834);
  if (violation != usb_pins) {
    gpio::alternate(gpio::a, 11, 10);
    gpio::alternate(gpio::a, 12, 10);
  }
  if (violation != usb_transceiver) word(gusbcfg) |= 1u << 6;
  if (violation != usb_core_reset) word(grstctl) |= 1;
  if (violation != usb_disturbed) {
    while ((word(grstctl) & 1) != 0) {
    }
    wait_us(1);
  }
  word(core + 0x38) = 1u << 16 | 1u << 21;
  word(gusbcfg) = (word(gusbcfg) & ~(0xFu << 10)) | (violation == usb_mode ? 0 : 1u << 30) |
                  (violation == usb_turnaround ? 0 : 6u << 10);
  if (violation != usb_mode_wait) wait_us(25'100);
  word(core + 0x800) |= violation == usb_speed ? 0 : 3;
  word(core + 0x804) &= ~2u;
  // The following steps need no host: an endpoint is loaded as if the device had been configured.
  word(core + 0x024) = 56;
  word(core + 0x028) = 16u << 16 | 56;
  word(core + 0x108) = 200u << 16 | 72;
  word(core + 0x940) = 1u << 28 | 2u << 22 | 2u << 18 | 1u << 15 | 64;
  word(core + 0x950) = 9u << 19 | 9 * 64;
  word(core + 0x940) |= 1u << 31 | 1u << 26;
  const unsigned packets = violation == usb_fifo_packets ? 9 : 8;
  for (unsigned i = 0; i < packets * 16; ++i) word(core + 0x3000) = i;
}

// Priorities, CFSR and the trace ports allow narrow writes (ARMv7-M, B3.2.1, C1.7.3).
void use_narrow_writes() {
  byte(0xE000ED1F) = 0x40;
  half(0xE000ED20) = 0x40;
  byte(0xE000E403) = 0x40;
  byte(0xE000ED29) = 0xFF;
  byte(0xE0000000) = 'x';
  if (violation == narrow_core_write) byte(0xE000ED10) = 0;
}

}  // namespace

void run() {
  word(rcc::ahb1enr) |= 8;
  read_back(rcc::ahb1enr);
  violation = word(0x40020C00 + gpio::idr);
  set_handler(3, [] {
    results[5] = word(0xE000ED28);
    for (;;) wait_for_interrupt();
  });
  if (violation == float_unit_off) word(0xE000ED88) = 0;
  asm volatile("dsb\n isb\n vmov.f32 s0, #1.0" ::: "s0", "memory");
  start_clocks();
  convert();
  convert_reference();
  use_others();
  start_usb();
  word(0xE000ED9C) = 0x2001'0000 | (violation == region_undefined ? 1u << 5 : 0) | 1 << 4;
  word(0xE000EDA0) = 3 << 24 | 3 << 16 | 9 << 1 | 1;
  word(0xE000ED98) = violation == region_number ? 8 : 7;
  if (violation == region_number_of_base) word(0xE000ED9C) = 1 << 4 | 8;
  word(0xE000ED9C) = 8;  // the region number is ignored without VALID
  use_narrow_writes();
  if (violation == core_reset) word(0xE000ED0C) = 0x05FA'0001;
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
