// What FPCCR and FPCAR say of the room that an exception has left for floats. Each handler notes both.
#include "protection.hpp"

namespace {

constexpr std::uint32_t control = 0xE000'EF34, place = 0xE000'EF38, monitor_control = 0xE000'EDFC;
constexpr std::uint32_t call_priority = 0xE000'ED1F, memory_priority = 0xE000'ED18, bus_priority = 0xE000'ED19,
                        monitor_priority = 0xE000'ED20;
volatile std::uint32_t* next = results + 1;

extern "C" void note(std::uint32_t stack) {
  *next++ = word(control);
  *next++ = word(place) - stack;
}
/// Notes, and gives a user all rights.
[[gnu::naked]] void handler() {
  asm volatile(
      "tst lr, #4\n ite eq\n mrseq r0, msp\n mrsne r0, psp\n push {r4, lr}\n bl note\n"
      "mrs r0, control\n bic r0, #1\n msr control, r0\n isb\n pop {r4, pc}");
}
/// Makes floats active, calls the supervisor and ends them.
[[gnu::naked, gnu::noinline]] void call_with_floats() {
  asm volatile("push {r4, lr}\n vmov.f32 s0, #1.0\n svc #0\n mov r0, #0\n msr control, r0\n isb\n pop {r4, pc}");
}
/// The same without rights and on another stack.
[[gnu::naked, gnu::noinline]] void call_as_user(std::uint32_t) {
  asm volatile(
      "push {r4, lr}\n msr psp, r0\n mov r0, #3\n msr control, r0\n isb\n vmov.f32 s0, #1.0\n svc #0\n"
      "mov r0, #0\n msr control, r0\n isb\n pop {r4, pc}");
}

}  // namespace

void run() {
  set_handler(11, handler);
  // results[1], [2]: nothing but HardFault could be pended.
  call_with_floats();
  // [3], [4]: all could, the call being less urgent than they.
  word(shcsr) = 1u << 16 | 1u << 17;
  word(monitor_control) = 1u << 16;
  call_with_floats();
  // [5], [6]: BASEPRI keeps two of them back.
  byte(memory_priority) = 0x20;
  byte(bus_priority) = 0x40;
  byte(monitor_priority) = 0x60;
  byte(call_priority) = 0x10;
  asm volatile("msr basepri, %0\n isb" ::"r"(0x40));
  call_with_floats();
  asm volatile("msr basepri, %0\n isb" ::"r"(0));
  // [7], [8]: what is interrupted is a handler of little urgency.
  set_handler(14, call_with_floats);
  byte(0xE000'ED22) = 0xF0;
  word(0xE000'ED04) = 1u << 28;
  barrier();
  // [9], [10]: a user, with bits in the stack pointer that are always 0.
  call_as_user(0x2001'1003);
  // [11]: stacked at once, so that FPCCR stays as it was written.
  word(control) = 1u << 31 | 1u << 3;
  call_with_floats();
  results[0] = finished;
}
