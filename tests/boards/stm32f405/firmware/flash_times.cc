// Erases and programs sector 2 with code in flash, while a timer interrupt runs from RAM and counts. Then programs
// words in an endless sequence.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t keyr = 0x40023C04, sr = 0x40023C0C, cr = 0x40023C10, busy = 1 << 16;
constexpr std::uint32_t sector = 0x08008000, by_words = 2 << 8;

alignas(512) volatile std::uint32_t vectors[128];

/// In RAM: counts, and reads the flash once during an erase.
[[gnu::section(".data.ram"), gnu::noinline]] void tick() {
  word(timer::tim2 + timer::sr) = 0;
  results[1] = results[1] + 1;
  if (results[8] == 1 && results[1] == 20) {
    const std::uint32_t before = cycles();
    results[9] = word(0x08008000);
    results[10] = cycles() - before;
  }
}

/// These are separate functions, because the fast mode checks the flash between blocks of instructions.
[[gnu::noinline]] void erase() {
  word(cr) = by_words | 2 << 3 | 1 << 1;
  word(cr) = by_words | 2 << 3 | 1 << 1 | 1 << 16;
  asm volatile("dsb" ::: "memory");
}

[[gnu::noinline]] void program(std::uint32_t offset, std::uint32_t value) {
  word(sector + offset) = value;
  asm volatile("dsb" ::: "memory");
}

}  // namespace

void run() {
  run_at_168_MHz();
  start_cycle_counter();
  for (unsigned i = 0; i < 128; ++i) vectors[i] = word(0x08000000 + 4 * i);
  vectors[interrupt(28)] = reinterpret_cast<std::uint32_t>(tick);
  word(0xE000ED08) = reinterpret_cast<std::uint32_t>(vectors);
  word(rcc::apb1enr) = word(rcc::apb1enr) | 1;
  asm volatile("dsb" ::: "memory");
  word(timer::tim2 + timer::arr) = 84'000 - 1;  // one millisecond
  word(timer::tim2 + timer::dier) = 1;
  word(timer::tim2 + timer::cr1) = 1;
  enable_interrupt(28, 0);
  word(keyr) = 0x45670123;
  word(keyr) = 0xCDEF89AB;
  asm volatile("isb" ::: "memory");

  std::uint32_t before = cycles();
  const std::uint32_t ticks_before = results[1];
  erase();
  results[2] = cycles() - before;  // the next instruction fetch from flash has waited for the whole operation
  results[3] = results[1] - ticks_before;
  results[4] = word(sr) & busy;
  word(cr) = by_words | 1;
  before = cycles();
  program(0, 0x12345678);
  program(4, 0xFFFF0000);
  results[5] = cycles() - before;
  program(4, 0x0F0F0F0F);
  results[6] = word(sector + 4);  // programming only clears bits
  results[7] = word(sector);
  results[1] = 0;
  results[8] = 1;
  erase();
  results[8] = 2;
  word(cr) = by_words | 1;
  results[0] = finished;
  for (std::uint32_t i = 0;; ++i)
    if (i < 0x1000) program(4 * i, 0x5A5A0000 + i);
}
