// Lets the independent watchdog (500 counts of 4 cycles of 32 kHz, 62.5 ms) bite once.
#include "support.hpp"

void run() {
  results[1] = word(rcc::csr);
  results[2] = results[2] + 1;
  word(rcc::csr) = 1u << 24;
  if ((results[1] & 1u << 29) != 0) {
    results[0] = finished;
    return;
  }
  word(0x40003000) = 0xCCCC;
  word(0x40003000) = 0x5555;
  word(0x40003004) = 0;
  word(0x40003008) = 499;
  word(0x40003000) = 0xAAAA;
  for (;;) results[3] = results[3] + 1;
}
