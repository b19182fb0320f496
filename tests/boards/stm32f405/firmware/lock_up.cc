// A typical crash: two calls deep the firmware reads an unmapped address. The HardFault handler executes a breakpoint,
// which locks up the core without a debugger.
#include "tests/boards/stm32f405/firmware/support.hpp"

extern "C" [[gnu::noinline]] std::uint32_t read_too_far(std::uint32_t address) { return word(address) + 1; }

extern "C" [[gnu::noinline]] std::uint32_t sum_up(std::uint32_t count) {
  std::uint32_t sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) sum += read_too_far(0x6000'0000 + i);
  return sum;
}

void run() {
  set_handler(3, [] { asm volatile("bkpt #0"); });
  results[0] = finished;
  results[1] = sum_up(8);
}
