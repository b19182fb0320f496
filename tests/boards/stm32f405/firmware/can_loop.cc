// CAN1 in silent loop-back mode receives the sent frames that pass the filters.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t can = 0x40006400, mcr = can, msr = can + 4, tsr = can + 8, rf0r = can + 0xC, rf1r = can + 0x10,
                        ier = can + 0x14, btr = can + 0x1C, mailbox = can + 0x180, fifo_0 = can + 0x1B0,
                        fifo_1 = can + 0x1C0, fmr = can + 0x200, fm1r = can + 0x204, fs1r = can + 0x20C,
                        ffa1r = can + 0x214, fa1r = can + 0x21C, banks = can + 0x240;
volatile std::uint32_t interrupts;

void send(std::uint32_t identifier_register, std::uint32_t length, std::uint32_t low, std::uint32_t high = 0) {
  word(mailbox + 4) = length;
  word(mailbox + 8) = low;
  word(mailbox + 12) = high;
  word(mailbox) = identifier_register | 1;
  while ((word(tsr) & 1) == 0) {
  }
  results[1] = results[1] + (word(tsr) >> 1 & 1) + (word(tsr) >> 26 & 1);  // without an error, and empty again
  word(tsr) = 1;
}

}  // namespace

void run() {
  word(rcc::apb1enr) |= 1u << 25;
  results[20] = word(rcc::apb1enr);
  word(mcr) = 1;
  while ((word(msr) & 3) != 1) {
  }
  word(btr) = 1u << 31 | 1u << 30 | 1 << 20 | 4 << 16 | 3;
  word(banks) = 0x120u << 21;  // bank 0: 32-bit mask for 0x120 to 0x127
  word(banks + 4) = 0x7F8u << 21 | 1u << 2;
  word(banks + 8) = 0x200u << 5 | 0x300u << 21;  // bank 1: four 16-bit identifiers for the second FIFO
  word(banks + 12) = 0x400u << 5 | 0x500u << 21;
  word(banks + 16) = 0x150u << 5 | 0x7FFu << 21;  // bank 2: 16-bit mask for the list in bank 3
  word(banks + 20) = word(banks + 16);
  word(banks + 24) = 0x150u << 21;
  word(fs1r) = 1 | 8;
  word(fm1r) = 2 | 8;
  word(ffa1r) = 2 | 8;
  word(fa1r) = 0xF;
  word(fmr) = word(fmr) & ~1u;
  word(mcr) = 0;
  while ((word(msr) & 3) != 0) {
  }
  set_handler(interrupt(20), [] {
    interrupts = interrupts + 1;
    word(ier) = 0;
  });
  enable_interrupt(20, 0);

  send(0x128u << 21, 1, 0x11);  // outside the mask
  results[2] = word(rf0r) | word(rf1r) << 8;
  word(ier) = 1 << 1;
  send(0x123u << 21, 5, 0x44332211, 0x55);
  results[3] = word(rf0r);
  results[4] = word(fifo_0);
  results[5] = word(fifo_0 + 4);
  results[6] = word(fifo_0 + 8);
  results[7] = word(fifo_0 + 12);
  results[8] = interrupts;
  send(0x500u << 21, 0, 0);
  results[9] = word(rf1r);
  results[10] = word(fifo_1 + 4);
  word(rf1r) = 1 << 5;
  send(0x150u << 21, 0, 0);
  results[14] = word(fifo_1 + 4);
  for (std::uint32_t i = 1; i <= 3; ++i) send((0x123u + i) << 21, 1, i);
  results[11] = word(rf0r);  // three frames, full, and the last frame was overwritten
  word(rf0r) = 1 << 5 | 1 << 4 | 1 << 3;
  results[12] = word(rf0r);
  word(rf0r) = 1 << 5;
  results[13] = word(fifo_0 + 8);
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
