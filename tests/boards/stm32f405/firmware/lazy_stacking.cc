// An exception reserves stack space for floating-point registers. Each handler records FPCCR and FPCAR, which describe
// this space.
#include "tests/boards/stm32f405/firmware/protection.hpp"

namespace {

constexpr std::uint32_t control = 0xE000'EF34, context_address = 0xE000'EF38, monitor_control = 0xE000'EDFC;
constexpr std::uint32_t call_priority = 0xE000'ED1F, memory_priority = 0xE000'ED18, bus_priority = 0xE000'ED19,
                        monitor_priority = 0xE000'ED20;
volatile std::uint32_t* next = results + 1;

extern "C" void note(std::uint32_t stack) {
  *next++ = word(control);
  *next++ = word(context_address) - stack;
}
/// Records the registers and makes the thread privileged.
[[gnu::naked]] void handler() {
  asm volatile(
      "tst lr, #4\n ite eq\n mrseq r0, msp\n mrsne r0, psp\n push {r4, lr}\n bl note\n"
      "mrs r0, control\n bic r0, #1\n msr control, r0\n isb\n pop {r4, pc}");
}
/// Activates the floating-point context, makes a supervisor call and deactivates the context.
[[gnu::naked, gnu::noinline]] void call_with_floats() {
  asm volatile("push {r4, lr}\n vmov.f32 s0, #1.0\n svc #0\n mov r0, #0\n msr control, r0\n isb\n pop {r4, pc}");
}
/// Makes the call in unprivileged mode on the process stack.
[[gnu::naked, gnu::noinline]] void call_as_user(std::uint32_t) {
  asm volatile(
      "push {r4, lr}\n msr psp, r0\n mov r0, #3\n msr control, r0\n isb\n vmov.f32 s0, #1.0\n svc #0\n"
      "mov r0, #0\n msr control, r0\n isb\n pop {r4, pc}");
}

}  // namespace

void run() {
  set_handler(11, handler);
  // results[1], [2]: only HardFault is ready to pend.
  call_with_floats();
  // [3], [4]: all are ready, because the supervisor call has a lower priority.
  word(shcsr) = 1u << 16 | 1u << 17;
  word(monitor_control) = 1u << 16;
  call_with_floats();
  // [5], [6]: BASEPRI masks two of them.
  byte(memory_priority) = 0x20;
  byte(bus_priority) = 0x40;
  byte(monitor_priority) = 0x60;
  byte(call_priority) = 0x10;
  asm volatile("msr basepri, %0\n isb" ::"r"(0x40));
  call_with_floats();
  asm volatile("msr basepri, %0\n isb" ::"r"(0));
  // [7], [8]: the interrupted code is a handler of low priority.
  set_handler(14, call_with_floats);
  byte(0xE000'ED22) = 0xF0;
  word(0xE000'ED04) = 1u << 28;
  barrier();
  // [9], [10]: unprivileged, with stack pointer bits that are always 0.
  call_as_user(0x2001'1003);
  // [11]: immediate stacking, so that FPCCR keeps the written value.
  word(control) = 1u << 31 | 1u << 3;
  call_with_floats();
  results[0] = finished;
}
