// Lets the independent watchdog expire once.
#include "tests/boards/stm32f405/firmware/support.hpp"

void run() {
  results[1] = word(rcc::csr);
  results[2] = results[2] + 1;
  word(rcc::csr) = 1u << 24;
  if ((results[1] & 1u << 29) != 0) {
    results[0] = finished;
    return;
  }
  watchdog::start();
  for (;;) results[3] = results[3] + 1;
}
