// Switches the bridges off after a CPU fault, writes a crash record and restarts. Records the code location of a main
// loop hang.
#include <algorithm>
#include <iterator>

#include "firmware/drivers/bridges_off.hpp"
#include "firmware/drivers/system.hpp"
#include "firmware/registers/peripherals.hpp"

#include "firmware/application/crash.hpp"
#include "firmware/application/handlers.hpp"
#include "firmware/application/memory.hpp"

namespace inkwell::application {

[[gnu::section(".noinit")]] drivers::KeptOverReset<protocol::CrashFacts> crash_record;

namespace {

using protocol::CrashFacts;

/// Registers r4 to r11, and the return value of the exception (EXC_RETURN).
struct SavedRegisters {
  std::uint32_t r4_to_r11[8];
  std::uint32_t exception_return;
};

/// Stack frame of an exception. If the floating-point registers were in use, space for these registers follows the
/// frame.
struct ExceptionFrame {
  std::uint32_t r0_to_r3[4];
  std::uint32_t r12, link_register, program_counter, program_status;
};

std::uint32_t address_of(const void* pointer) { return reinterpret_cast<std::uint32_t>(pointer); }

/// Returns the stack pointer before the exception (ARMv7-M, B1.5.7 "Stack alignment on exception entry").
std::uint32_t stack_before(const ExceptionFrame* frame, std::uint32_t exception_return) {
  constexpr std::uint32_t no_floats = 1u << 4, was_aligned = 1u << 9, bytes_of_floats = 72;
  return address_of(frame + 1) + ((exception_return & no_floats) != 0 ? 0 : bytes_of_floats) +
         ((frame->program_status & was_aligned) != 0 ? 4 : 0);
}

/// Returns true if the address directly follows a call instruction in firmware code. The call instructions are BL and
/// BLX (ARMv7-M, A7.7.18 and A7.7.19).
bool is_after_call(std::uint32_t address) {
  const auto lies_in = [address](const std::uint32_t* begin, const std::uint32_t* end) {
    return address >= address_of(begin) + 4 && address < address_of(end);
  };
  if (address % 2 != 0) return false;
  if (!lies_in(text_begin, image_check) && !lies_in(interrupt_text_begin, interrupt_text_end)) return false;
  const auto* after_call = reinterpret_cast<const std::uint16_t*>(address);
  return ((after_call[-2] & 0xF800) == 0xF000 && (after_call[-1] & 0xD000) == 0xD000) ||
         (after_call[-1] & 0xFF87) == 0x4780;
}

/// The record contains all possible return addresses on the stack, because the code has no frame pointers.
void note_callers(CrashFacts& crash) {
  std::size_t count = 0;
  const auto consider = [&](std::uint32_t word) {
    if ((word & 1) != 0 && is_after_call(word - 1)) crash.callers[count++] = word - 1;
  };
  consider(crash.link_register);
  const auto* word = reinterpret_cast<const std::uint32_t*>(crash.stack_pointer);
  for (; word < stack_top && count < std::size(crash.callers); ++word) consider(*word);
}

/// Collects the facts of the current exception.
CrashFacts facts_of(const ExceptionFrame* frame, const SavedRegisters* saved) {
  using registers::SCB;
  CrashFacts crash{};
  asm volatile("mrs %0, ipsr" : "=r"(crash.exception));
  crash.configurable_fault_status = SCB::CFSR::read();
  crash.hard_fault_status = SCB::HFSR::read();
  crash.fault_address =
      SCB::CFSR::MMARVALID::from(crash.configurable_fault_status) != 0 ? SCB::MMFAR::read() : SCB::BFAR::read();
  crash.image_check = *image_check;
  std::copy_n(saved->r4_to_r11, 8, crash.registers + 4);
  const std::uint32_t address = address_of(frame);
  if (address % 4 == 0 && address >= address_of(stack_bottom) && address + sizeof *frame <= address_of(stack_top)) {
    std::copy_n(frame->r0_to_r3, 4, crash.registers);
    crash.registers[12] = frame->r12;
    crash.link_register = frame->link_register;
    crash.program_counter = frame->program_counter;
    crash.program_status = frame->program_status;
    crash.stack_pointer = stack_before(frame, saved->exception_return);
    note_callers(crash);
  }
  return crash;
}

}  // namespace

/// The handler first switches the motors off. This code does not use the stack, because the stack may be damaged. The
/// handler then uses the lowest 512 bytes of the stack to create the crash record. These bytes are unused unless the
/// stack has overflowed. No interrupt can preempt this function, because CPU faults have the highest priority. A second
/// CPU fault in this function restarts the function as a hard fault handler. A CPU fault in the hard fault handler
/// locks up the processor until the watchdog expires.
extern "C" [[gnu::naked]] void cpu_fault_handler() {
  asm volatile(
      "ldr r2, =%c[enable_address] \n"
      "ldr r3, =%c[enable_low] \n"
      "str r3, [r2] \n"
      "ldr r2, =%c[legs_a_address] \n"
      "ldr r3, =%c[off] \n"
      "str r3, [r2] \n"
      "ldr r2, =%c[legs_b_address] \n"
      "str r3, [r2] \n"
      "mov r0, sp \n"
      "ldr r1, =stack_bottom + 512 \n"
      "mov sp, r1 \n"
      "push {r4-r11, lr} \n"
      "mov r1, sp \n"
      "b record_cpu_fault \n"
      ".ltorg \n" ::[enable_address] "i"(drivers::bridge_enable_low.address),
      [enable_low] "i"(drivers::bridge_enable_low.value), [legs_a_address] "i"(drivers::legs_a_off.address),
      [legs_b_address] "i"(drivers::legs_b_off.address), [off] "i"(drivers::outputs_off));
}

extern "C" [[noreturn, gnu::used]] void record_cpu_fault(const ExceptionFrame* frame, const SavedRegisters* saved) {
  crash_record.store(facts_of(frame, saved));
  drivers::reset_chip();
}

/// The control interrupt requests this exception and can preempt this handler. The handler preempts only the main loop,
/// so the stack contains the state of the main loop. After the handler, the main loop may continue.
extern "C" [[gnu::naked]] void hang_handler() {
  asm volatile(
      "mov r0, sp \n"
      "push {r4-r11, lr} \n"
      "mov r1, sp \n"
      "sub sp, #4 \n"  // a call requires an 8-byte aligned stack
      "bl record_hang \n"
      "add sp, #4 \n"
      "dsb \n"  // like drivers::finish_stores()
      "pop {r4-r11, pc} \n");
}

extern "C" [[gnu::used]] void record_hang(const ExceptionFrame* frame, const SavedRegisters* saved) {
  crash_record.store(facts_of(frame, saved));
}

}  // namespace inkwell::application
