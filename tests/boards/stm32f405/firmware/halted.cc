// SysTick, RTC and CAN1 run, and their progress is recorded continuously. The test sets DBGMCU_APB1_FZ through
// results[20].
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t stk_ctrl = 0xE000E010, stk_load = 0xE000E014, stk_val = 0xE000E018, apb1_fz = 0xE0042008,
                        bdcr = 0x40023870, pwr_cr = 0x40007000;
constexpr std::uint32_t rtc_cr = 0x40002808, rtc_isr = 0x4000280C, rtc_prer = 0x40002810, rtc_wutr = 0x40002814,
                        rtc_wpr = 0x40002824, rtc_ssr = 0x40002828;
constexpr std::uint32_t can_mcr = 0x40006400, can_msr = 0x40006404, can_tsr = 0x40006408, can_btr = 0x4000641C,
                        can_mailbox = 0x40006580;

/// LSI runs at 32 kHz and SSR counts its cycles down. The wake-up timer has a period of 15 ms.
void start_clock() {
  word(pwr_cr) = 1 << 8;
  word(rcc::csr) |= 1;
  while ((word(rcc::csr) & 2) == 0) {
  }
  word(bdcr) = 2 << 8 | 1 << 15;
  word(rtc_wpr) = 0xCA;
  word(rtc_wpr) = 0x53;
  word(rtc_isr) = 1 << 7;
  while ((word(rtc_isr) & 1 << 6) == 0) {
  }
  word(rtc_prer) = 0x7FFF;
  word(rtc_isr) = 0;
  word(rtc_wutr) = 29;
  word(rtc_cr) = 1 << 10;
}

/// Silent loop-back at 5000 bit/s: a frame takes 9 ms.
void start_bus() {
  word(can_mcr) = 1 << 16 | 1;
  while ((word(can_msr) & 3) != 1) {
  }
  word(can_btr) = 1u << 31 | 1u << 30 | 1066;
  word(can_mcr) = 1 << 16;
  while ((word(can_msr) & 3) != 0) {
  }
}

}  // namespace

void run() {
  word(rcc::apb1enr) |= 1 << 28 | 1 << 25;
  results[30] = word(rcc::apb1enr);
  start_clock();
  start_bus();
  word(stk_load) = 0xFF'FFFF;
  word(stk_val) = 0;
  word(stk_ctrl) = 5;
  word(can_mailbox) = 1;
  results[0] = finished;
  for (;;) {
    word(apb1_fz) = results[20];
    results[1] = word(stk_val);
    results[2] = word(rtc_ssr);
    if ((word(rtc_isr) & 1 << 10) != 0) {
      word(rtc_isr) = ~(1u << 10 | 1u << 7);
      results[3] = results[3] + 1;
    }
    if ((word(can_tsr) & 1) != 0) {
      word(can_tsr) = 1;
      word(can_mailbox) = 1;
      results[4] = results[4] + 1;
    }
  }
}
