// Priorities, tail-chaining, masks, supervisor calls on the process stack, and the floating-point context.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

std::uint32_t order;  // one digit per event, in order
void mark(std::uint32_t digit) { order = order * 16 + digit; }
void pend(unsigned position) {
  word(0xE000E200 + position / 32 * 4) = 1u << position % 32;
  asm volatile("dsb\n isb" ::: "memory");
}

volatile std::uint32_t ticks;
void systick() { ticks = ticks + 1; }

void low() {
  mark(1);
  pend(7);  // higher priority: preempts here
  pend(8);  // equal priority: waits for the return and is tail-chained
  mark(2);
}
void high() { mark(3); }
void equal() { mark(4); }

[[gnu::naked]] void supervisor_call() {
  // Doubles R0 of the caller's frame. Bit 2 of EXC_RETURN selects the stack of the frame.
  asm volatile(
      "tst lr, #4\n ite eq\n mrseq r0, msp\n mrsne r0, psp\n ldr r1, [r0]\n add r1, r1\n str r1, [r0]\n bx lr");
}
volatile std::uint32_t pendsv_return;
[[gnu::naked]] void pendsv() { asm volatile("ldr r0, =%c0\n str lr, [r0]\n bx lr\n .ltorg" ::"i"(&pendsv_return)); }

alignas(8) std::uint32_t process_stack[64];

std::uint32_t call_twice(std::uint32_t value) {
  register std::uint32_t r0 asm("r0") = value;
  asm volatile("svc #0" : "+r"(r0)::"r1", "memory");
  return r0;
}

volatile float product;
void spoil_floats() {
  float x = product;
  asm volatile("vmov.f32 s0, %0\n vmov.f32 s15, %0\n vmov.f32 s16, %0\n vmsr fpscr, %1" ::"t"(x), "r"(0x00C00000)
               : "s0", "s15", "s16");
  mark(5);
}

}  // namespace

void run() {
  set_handler(15, systick);
  set_handler(interrupt(6), low);
  set_handler(interrupt(7), high);
  set_handler(interrupt(8), equal);
  set_handler(interrupt(9), spoil_floats);
  set_handler(11, supervisor_call);
  set_handler(14, pendsv);
  enable_interrupt(6, 5);
  enable_interrupt(7, 3);
  enable_interrupt(8, 5);
  enable_interrupt(9, 6);

  pend(6);
  results[1] = order;

  // BASEPRI masks interrupt 5 and passes 3; PRIMASK masks all.
  order = 0;
  asm volatile("msr basepri, %0" ::"r"(4 << 4));
  pend(8);
  pend(7);
  mark(9);
  asm volatile("msr basepri, %0\n isb" ::"r"(0));
  mark(8);
  asm volatile("cpsid i");
  pend(7);
  mark(9);
  asm volatile("cpsie i\n isb");
  results[2] = order;

  // Thread mode on the process stack.
  asm volatile("msr psp, %0\n mrs r3, control\n orr r3, #2\n msr control, r3\n isb" ::"r"(process_stack + 64) : "r3");
  results[3] = call_twice(21);
  word(0xE000ED04) = 1u << 28;
  asm volatile("dsb\n isb");
  results[4] = pendsv_return;
  asm volatile("mrs r3, control\n bic r3, #2\n msr control, r3\n isb" ::: "r3");

  // An interrupt that uses S0 to S15 and FPSCR preserves them.
  order = 0;
  float a = 1.5f, b = 2.25f;
  std::uint32_t status = 0;
  asm volatile(
      "vmov.f32 s0, %2\n vmov.f32 s15, %3\n vmov r3, s0\n"
      "str %5, [%4]\n dsb\n isb\n vmov.f32 %0, s15\n vmrs %1, fpscr"
      : "=t"(b), "=r"(status)
      : "t"(a), "t"(b), "r"(0xE000E200), "r"(1u << 9)
      : "r3", "s0", "s15", "memory");
  asm volatile("vstr.f32 %0, [%1]" ::"t"(b), "r"(const_cast<std::uint32_t*>(&results[5])) : "memory");
  results[6] = status & 0x00C00000;
  results[7] = order;

  // SysTick: ten periods of 1000 cycles at 16 MHz, with sleep in between.
  word(0xE000E014) = 999;
  word(0xE000E018) = 0;
  word(0xE000E010) = 7;
  while (ticks < 10) wait_for_interrupt();
  word(0xE000E010) = 0;
  results[8] = ticks;
  results[0] = finished;
}
