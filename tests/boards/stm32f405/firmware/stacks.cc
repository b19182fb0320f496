// Raises exceptions with the stack beyond the end of RAM, and in memory that the protection unit refuses. The handlers
// first switch to a valid stack.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t shcsr = 0xE000ED24, cfsr = 0xE000ED28, hfsr = 0xE000ED2C, mpu_control = 0xE000ED94,
                        mpu_base = mpu_control + 8, mpu_attributes = mpu_control + 12, good_stack = 0x20018000;

[[noreturn]] void second();

// Thread mode continues after the handler with a frame that the handler creates.
[[gnu::naked]] void go_on(void (*)(), std::uint32_t) {
  asm volatile(
      "mov sp, r1\n sub sp, #32\n str r0, [sp, #24]\n mov r0, #0x01000000\n str r0, [sp, #28]\n"
      "mvn lr, #6\n bx lr");
}

extern "C" void note_bus_fault(std::uint32_t stack) {
  results[1] = word(cfsr);
  results[2] = stack;
  results[3] = word(hfsr);
  word(cfsr) = results[1];
  go_on(second, good_stack);
}
[[gnu::naked]] void bus_fault() { asm volatile("mov r0, sp\n ldr r1, =0x20018000\n mov sp, r1\n b note_bus_fault"); }

void supervisor_call() { results[6] = 7; }

[[noreturn]] void third() {
  results[0] = finished;
  for (;;) wait_for_interrupt();
}

extern "C" void note_hard_fault() {
  results[4] = word(cfsr);
  results[5] = word(hfsr);
  word(mpu_control) = 0;
  asm volatile("dsb" ::: "memory");
  go_on(third, good_stack);
}
[[gnu::naked]] void hard_fault() { asm volatile("ldr r1, =0x20018000\n mov sp, r1\n b note_hard_fault"); }

void second() {
  // Only CPU fault handlers may write to this 1 kB, because HFNMIENA is 0.
  word(mpu_base) = 0x20010000 | 1 << 4;
  word(mpu_attributes) = 6u << 24 | 9 << 1 | 1;
  word(mpu_control) = 1 | 1 << 2;
  asm volatile("dsb\n isb\n ldr r0, =0x20010200\n mov sp, r0\n svc #0" ::: "r0", "memory");
  for (;;) wait_for_interrupt();
}

}  // namespace

void run() {
  set_handler(3, hard_fault);
  set_handler(5, bus_fault);
  set_handler(11, supervisor_call);
  word(shcsr) = 1 << 17;
  asm volatile("ldr r0, =0x20020080\n mov sp, r0\n svc #0" ::: "r0", "memory");
}
