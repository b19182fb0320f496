// The memory protection unit refuses parts of exception frames during stacking, unstacking and lazy stacking. The CPU
// fault handler removes the cause.
#include "tests/boards/stm32f405/firmware/protection.hpp"

namespace {

constexpr std::uint32_t stack = 0x2001'1000, context_control = 0xE000'EF34, lazily_active = 1;
volatile std::uint32_t* next = results + 1;
void note(std::uint32_t value) { *next++ = value; }

extern "C" void mend_stack() {
  take_regions_away();
  note(word(cfsr) | (word(context_control) & lazily_active) << 31);
  word(cfsr) = 0xFFFF'FFFF;
}
[[gnu::naked]] void refusal() { asm volatile("push {r4, lr}\n bl mend_stack\n pop {r4, pc}"); }

/// Makes a supervisor call with the process stack at this address.
[[gnu::naked, gnu::noinline]] void call_on(std::uint32_t) {
  asm volatile(
      "push {r4, lr}\n msr psp, r0\n mov r0, #2\n msr control, r0\n isb\n"
      "svc #0\n"
      "mov r0, #0\n msr control, r0\n isb\n pop {r4, pc}");
}
/// The same with an active floating-point register; returns its value afterwards.
[[gnu::naked, gnu::noinline]] std::uint32_t call_with_float_on(std::uint32_t) {
  asm volatile(
      "push {r4, lr}\n msr psp, r0\n mov r0, #2\n msr control, r0\n isb\n"
      "vmov.f32 s0, #2.0\n svc #0\n vmov r1, s0\n"
      "mov r0, #0\n msr control, r0\n isb\n mov r0, r1\n pop {r4, pc}");
}
/// The same for a lost frame: continues after the call with only the registers saved on the main stack.
[[gnu::naked, gnu::noinline]] void call_and_lose(std::uint32_t, std::uint32_t*) {
  asm volatile(
      "push {r4-r11, lr}\n msr psp, r0\n adr r0, 1f\n str r0, [r1]\n mov r0, #2\n msr control, r0\n isb\n"
      "svc #0\n .align 2\n"
      "1: mov r0, #0\n msr control, r0\n isb\n pop {r4-r11, pc}");
}
std::uint32_t resume_at;

// results[1], [2]: only the second half of the frame is refused. SVC follows the fault, on the frame that was never
// written.
void lose_frame() {
  constexpr std::uint32_t top = stack - 48;
  set_handler(11, [] {
    note(0x5C);
    word(top - 8) = resume_at;
    word(top - 4) = 1u << 24;
  });
  set_rights(0, stack - 64, 5, read_only);
  protect(enable | default_map);
  call_and_lose(top, &resume_at);
}

// results[3], [4]: the written frame cannot be read back.
void lose_way_back() {
  set_handler(11, [] {
    set_rights(0, stack - 32, 5, none);
    protect(enable | default_map);
    note(0x5C);
  });
  call_on(stack);
}

constexpr std::uint32_t float_stack = stack - 8, stacked_float = float_stack - 0x68 + 0x20;

void take_float() {
  note(word(context_control) & lazily_active);
  asm volatile("vmov.f32 s0, #3.0" ::: "s0");
  note(word(context_control) & lazily_active);
}

// results[5] to [9]: the first floating-point instruction starts lazy stacking, which is refused and then repeated.
void stack_floats_late() {
  set_handler(11, take_float);
  set_rights(0, stack - 64, 5, read_only);
  protect(enable | default_map);
  note(call_with_float_on(float_stack));
  note(word(stacked_float));
}

// results[10] to [13]: a handler that MemManage cannot preempt continues, and the registers to be stacked are lost.
void lose_floats() {
  word(stacked_float) = 7;
  set_rights(0, stack - 64, 5, read_only);
  protect(enable | default_map);
  note(call_with_float_on(float_stack));
}

// results[14], [15]: the same, but the handler cancels the lazy stacking first.
void drop_floats() {
  word(stacked_float) = 8;
  set_handler(11, [] {
    word(context_control) &= ~lazily_active;
    asm volatile("vmov.f32 s0, #3.0" ::: "s0");
  });
  set_rights(0, stack - 64, 5, read_only);
  protect(enable | default_map);
  note(call_with_float_on(float_stack));
  take_regions_away();
  note(0x5C);
}

// results[16]: a handler without floating-point instructions starts no lazy stacking.
void leave_floats() {
  set_handler(11, [] {});
  set_rights(0, stack - 64, 5, read_only);
  protect(enable | default_map);
  note(call_with_float_on(float_stack));
  take_regions_away();
}

}  // namespace

void run() {
  constexpr std::uint32_t call_priority = 0xE000'ED1F;
  set_handler(4, refusal);
  word(shcsr) = 1 << 16;
  byte(call_priority) = 0x40;  // lower priority than MemManage
  lose_frame();
  lose_way_back();
  stack_floats_late();
  byte(call_priority) = 0;
  lose_floats();
  drop_floats();
  leave_floats();
  results[0] = finished;
}
