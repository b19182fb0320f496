// Functions in RAM that are written, run, and written anew: in one page, and across the end of a page.
#include "support.hpp"

namespace {

alignas(4096) std::uint16_t code[4096];

std::uint32_t call(const std::uint16_t* function) {
  asm volatile("dsb\n isb" ::: "memory");
  return reinterpret_cast<std::uint32_t (*)()>(reinterpret_cast<std::uintptr_t>(function) | 1)();
}

/// Writes "return value" and calls it.
std::uint32_t write_and_call(volatile std::uint16_t* place, std::uint32_t value) {
  place[0] = static_cast<std::uint16_t>(0x2000 | value);  // movs r0, #value
  place[1] = 0x4770;                                      // bx lr
  return call(const_cast<const std::uint16_t*>(place));
}

}  // namespace

void run() {
  std::uint32_t wrong = 0;
  for (std::uint32_t value = 0; value < 100; ++value) {
    wrong += write_and_call(code + 16, value) != value;
    wrong += write_and_call(code + 2047, 200 - value) != 200 - value;  // the return is in the next page
  }
  results[1] = wrong;
  // Only the second page changes under the function that crosses into it.
  volatile std::uint16_t* const across = code + 2046;
  across[0] = 0x2007;
  across[1] = 0x3001;  // adds r0, #1
  across[2] = 0x3010;  // adds r0, #16, in the next page
  across[3] = 0x4770;
  results[2] = call(code + 2046);
  across[2] = 0x3020;
  results[3] = call(code + 2046);
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
