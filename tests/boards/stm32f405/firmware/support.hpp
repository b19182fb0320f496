// Support for the test firmwares: registers by address, handlers by exception number, and results for the test.
#pragma once

#include <cstdint>

inline volatile std::uint32_t& word(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}
inline volatile std::uint16_t& half(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint16_t*>(address);
}
inline volatile std::uint8_t& byte(std::uint32_t address) { return *reinterpret_cast<volatile std::uint8_t*>(address); }

/// Words that the test reads at 0x2001F000.
inline volatile std::uint32_t* const results = reinterpret_cast<volatile std::uint32_t*>(0x2001F000);
/// Value of results[0] after the test firmware has finished.
inline constexpr std::uint32_t finished = 0x600D600D;

using Handler = void (*)();
void set_handler(unsigned exception, Handler handler);
inline constexpr unsigned interrupt(unsigned position) { return 16 + position; }
void enable_interrupt(unsigned position, unsigned priority);
/// Sets HCLK to 168 MHz, PCLK1 to 42 MHz and PCLK2 to 84 MHz, from the 8 MHz crystal.
void run_at_168_MHz();

inline void wait_for_interrupt() { asm volatile("wfi" ::: "memory"); }
inline std::uint32_t cycles() { return word(0xE0001004); }
void start_cycle_counter();
/// Maps SRAM1 to address 0.
void remap_sram1();

namespace rcc {
inline constexpr std::uint32_t cr = 0x40023800, pllcfgr = 0x40023804, cfgr = 0x40023808, ahb1enr = 0x40023830,
                               apb1enr = 0x40023840, apb2enr = 0x40023844, csr = 0x40023874;
}
namespace gpio {
inline constexpr std::uint32_t a = 0x40020000, b = 0x40020400, c = 0x40020800;
inline constexpr std::uint32_t moder = 0x00, pupdr = 0x0C, idr = 0x10, odr = 0x14, bsrr = 0x18, afrl = 0x20,
                               afrh = 0x24;
void alternate(std::uint32_t port, unsigned pin, unsigned function);
}  // namespace gpio
namespace timer {
inline constexpr std::uint32_t tim1 = 0x40010000, tim2 = 0x40000000, tim3 = 0x40000400, tim8 = 0x40010400;
inline constexpr std::uint32_t cr1 = 0x00, cr2 = 0x04, smcr = 0x08, dier = 0x0C, sr = 0x10, egr = 0x14, ccmr1 = 0x18,
                               ccmr2 = 0x1C, ccer = 0x20, cnt = 0x24, psc = 0x28, arr = 0x2C, rcr = 0x30, ccr1 = 0x34,
                               ccr2 = 0x38, ccr3 = 0x3C, ccr4 = 0x40, bdtr = 0x44;
}  // namespace timer
namespace adc {
inline constexpr std::uint32_t adc1 = 0x40012000, adc2 = 0x40012100, adc3 = 0x40012200, ccr = 0x40012304;
inline constexpr std::uint32_t sr = 0x00, cr1 = 0x04, cr2 = 0x08, smpr1 = 0x0C, sqr1 = 0x2C, sqr2 = 0x30, sqr3 = 0x34,
                               jsqr = 0x38, jdr1 = 0x3C, dr = 0x4C;
/// Sets up stream 0 of DMA2 to copy `items` values of the common data register to `to`. `size` is 1 for half words and
/// 2 for words.
void collect_common_data(std::uint32_t size, std::uint32_t items, volatile std::uint32_t* to);
std::uint32_t items_left();
/// Waits for the last item, with a time limit.
void wait_for_items();
}  // namespace adc
namespace watchdog {
/// 500 counts of 4 cycles at 32 kHz: the watchdog expires after 62.5 ms.
void start();
}  // namespace watchdog

/// Entry point that each test firmware defines.
void run();
