// Locks up the core once, with a watchdog of 62.5 ms.
#include "tests/boards/stm32f405/firmware/support.hpp"

void run() {
  if ((word(rcc::csr) & 1u << 29) != 0) {
    results[0] = finished;
    return;
  }
  watchdog::start();
  set_handler(3, [] { asm volatile("bkpt #0"); });
  word(0x60000000) = 0;
}
