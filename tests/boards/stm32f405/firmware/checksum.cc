// The CRC unit: clock enable, results, and both methods of reset.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {
constexpr std::uint32_t dr = 0x40023000, idr = 0x40023004, cr = 0x40023008, ahb1rstr = 0x40023810, enable = 1u << 12;
}

void run() {
  results[1] = word(dr);  // without its clock
  word(rcc::ahb1enr) |= enable;
  results[2] = word(dr);
  word(dr) = 0x12345678;
  results[3] = word(dr);
  word(dr) = 0xDEADBEEF;
  results[4] = word(dr);
  byte(idr) = 0xA5;
  word(cr) = 1;
  results[5] = word(dr);
  results[6] = word(idr);
  word(ahb1rstr) = enable;
  word(ahb1rstr) = 0;
  results[7] = word(idr);
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
