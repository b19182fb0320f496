// The thread records its progress and masks SysTick half of the time, first with PRIMASK, then with BASEPRI.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

void count() { results[1] = results[1] + 1; }

void work(unsigned mark) {
  results[3] = mark;
  for (unsigned i = 0; i < 1000; ++i) results[2] = results[2] + 1;
}

}  // namespace

void run() {
  set_handler(15, count);
  word(0xE000ED20) = 4u << 28;  // SysTick's priority
  word(0xE000E014) = 999;
  word(0xE000E018) = 0;
  word(0xE000E010) = 7;
  results[0] = finished;
  for (;;) {
    work(1);
    asm volatile("cpsid i");
    work(2);
    asm volatile("cpsie i\n isb");
    work(3);
    asm volatile("msr basepri, %0" ::"r"(4 << 4));
    work(4);
    asm volatile("msr basepri, %0\n isb" ::"r"(0));
  }
}
