// Writes functions to RAM, executes them and overwrites them. The functions are within one page, cross a page boundary,
// or have different instruction timing.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

alignas(4096) std::uint16_t code[4096];

std::uint32_t call(const std::uint16_t* function) {
  asm volatile("dsb\n isb" ::: "memory");
  return reinterpret_cast<std::uint32_t (*)()>(reinterpret_cast<std::uintptr_t>(function) | 1)();
}

/// Writes a function that returns `value`, and calls it.
std::uint32_t write_and_call(volatile std::uint16_t* target, std::uint32_t value) {
  target[0] = static_cast<std::uint16_t>(0x2000 | value);  // movs r0, #value
  target[1] = 0x4770;                                      // bx lr
  return call(const_cast<const std::uint16_t*>(target));
}

/// Writes a 32-bit and a 16-bit instruction, and returns the cycles of their second execution.
std::uint32_t write_and_time(std::uint32_t wide, std::uint16_t narrow) {
  volatile std::uint16_t* const target = code + 64;
  target[0] = static_cast<std::uint16_t>(wide >> 16);
  target[1] = static_cast<std::uint16_t>(wide);
  target[2] = narrow;
  target[3] = 0x4770;
  call(code + 64);
  const std::uint32_t before = cycles();
  call(code + 64);
  return cycles() - before;
}

}  // namespace

void run() {
  std::uint32_t wrong = 0;
  for (std::uint32_t value = 0; value < 100; ++value) {
    wrong += write_and_call(code + 16, value) != value;
    wrong += write_and_call(code + 2047, 200 - value) != 200 - value;  // the return instruction is in the next page
  }
  results[1] = wrong;
  // Changes only the second page of a function that crosses the page boundary.
  volatile std::uint16_t* const across = code + 2046;
  across[0] = 0x2007;
  across[1] = 0x3001;  // adds r0, #1
  across[2] = 0x3010;  // adds r0, #16, in the next page
  across[3] = 0x4770;
  results[2] = call(code + 2046);
  across[2] = 0x3020;
  results[3] = call(code + 2046);
  // The second function has the same address and length but other timing.
  start_cycle_counter();
  constexpr std::uint32_t add_r3 = 0xF1030301, push_r1_to_r12 = 0xE92D1FFE;
  constexpr std::uint16_t keep_stack = 0xB000, drop_12_words = 0xB00C;
  results[4] = write_and_time(add_r3, keep_stack);
  results[5] = write_and_time(push_r1_to_r12, drop_12_words);
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
