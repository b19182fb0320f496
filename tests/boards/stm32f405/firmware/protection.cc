// Access checks of the memory protection unit. Each probe records one word: the CFSR bits, or 0 if it passed. Bit 30:
// the fault was a HardFault. Bit 31: MMFAR is valid and outside the accessed range.
#include "tests/boards/stm32f405/firmware/protection.hpp"

namespace {

constexpr std::uint32_t came_as_hard_fault = 1u << 30, other_address = 1u << 31;

volatile std::uint32_t status = 0, probed_address = 0, program_counter = 0;
/// Action of a CPU fault handler before it returns.
Handler volatile mend = nullptr;

/// A probe that faults returns to its caller.
extern "C" void note_refusal(std::uint32_t* frame, std::uint32_t exception) {
  status = word(cfsr) | (exception == 3 ? came_as_hard_fault : 0);
  const std::uint32_t fault_address = word(mmfar);
  if ((status & 0x80) != 0 && fault_address - probed_address >= 4) status |= other_address;
  program_counter = frame[6];
  word(cfsr) = 0xFFFFFFFF;
  word(hfsr) = 0xFFFFFFFF;
  if (mend != nullptr)
    mend();
  else
    frame[6] = frame[5] & ~1u;
}
[[gnu::naked]] void refusal() {
  asm volatile(
      "tst lr, #4\n ite eq\n mrseq r0, msp\n mrsne r0, psp\n mrs r1, ipsr\n"
      "push {r4, lr}\n bl note_refusal\n pop {r4, pc}");
}

[[gnu::naked, gnu::noinline]] void load_word(std::uint32_t) { asm volatile("ldr r0, [r0]\n bx lr"); }
[[gnu::naked, gnu::noinline]] void store_word(std::uint32_t) { asm volatile("str r0, [r0]\n bx lr"); }
[[gnu::naked, gnu::noinline]] void run_at(std::uint32_t) { asm volatile("orr r0, #1\n bx r0"); }

using Probe = void (*)(std::uint32_t);
std::uint32_t verdict(Probe probe, std::uint32_t address) {
  status = 0;
  probed_address = address;
  probe(address);
  return status;
}
void supervisor_call();
[[gnu::naked]] void become_privileged() { asm volatile("svc #0\n bx lr"); }
void supervisor_call() { asm volatile("mrs r0, control\n bic r0, #1\n msr control, r0" ::: "r0"); }
std::uint32_t verdict_of_user(Probe probe, std::uint32_t address) {
  asm volatile("mrs r0, control\n orr r0, #1\n msr control, r0\n isb" ::: "r0", "memory");
  verdict(probe, address);
  const std::uint32_t found = verdict(probe, address);  // still unprivileged after the fault
  become_privileged();
  return found;
}

/// Gives all code access to flash and SRAM, as a background for regions from 2 on.
void let_everybody_run() {
  set_rights(0, 0x0800'0000, 20, read_only);
  set_rights(1, 0x2000'0000, 17, all);
}

volatile std::uint32_t* next = results + 1;
void note(std::uint32_t value) { *next++ = value; }

// results[1] to [11]: regions divide a page, and one region has a disabled third eighth. The region with the higher
// number has priority.
void probe_regions() {
  set_rights(0, 0x2001'0000, 12, read_only);
  set_region(1, 0x2001'0100, all << 24 | 1u << (8 + 2) | size(8) | normal);
  set_rights(2, 0x2001'2000, 5, none);
  protect(enable | default_map);
  note(verdict(load_word, 0x2001'0000));
  note(verdict(store_word, 0x2001'0000));
  note(verdict(store_word, 0x2001'0100));
  note(verdict(store_word, 0x2001'0140));  // the disabled subregion
  note(verdict(store_word, 0x2001'0160));
  note(verdict(store_word, 0x2001'00FE));  // each end of an access is checked
  note(verdict(store_word, 0x2001'01FE));
  note(verdict(load_word, 0x2001'1FFE));  // across a page boundary
  note(verdict(store_word, 0x2001'1FFE));
  note(verdict(store_word, 0x2001'1FFC));
  note(verdict(store_word, 0x2001'2020));
  take_regions_away();
}

// results[12] to [21]: instruction fetches.
void probe_fetches() {
  constexpr std::uint16_t no_operation = 0xBF00, return_to_caller = 0x4770;
  constexpr std::uint32_t code = 0x2001'4000;
  for (std::uint32_t at = code; at < code + 0x60; at += 2) half(at) = no_operation;
  half(code + 0x60) = return_to_caller;
  half(code + 0x3E) = 0xF3AF;  // 32-bit NOP
  half(code + 0x40) = 0x8000;
  set_rights(0, code + 0x40, 5, all, normal | execute_never);
  protect(enable | default_map);
  note(verdict(store_word, code + 0x44));
  half(code + 0x44) = no_operation;
  half(code + 0x46) = no_operation;
  note(verdict(run_at, code + 0x60));
  note(verdict(run_at, code));  // execution continues into the next region
  note(program_counter - code);
  half(code + 0x3E) = no_operation;
  half(code + 0x40) = no_operation;
  note(verdict(run_at, code));
  note(program_counter - code);
  protect(0);
  note(verdict(run_at, code));
  protect(enable | default_map);  // the instructions were executed before the change
  note(verdict(run_at, code));
  note(program_counter - code);
  note(verdict(run_at, 0x4002'0000));  // rule of the default map
  take_regions_away();
}

// results[22] to [29]: for each AP code, whether privileged and unprivileged loads and stores pass.
void probe_rights() {
  let_everybody_run();
  protect(enable | default_map);
  for (std::uint32_t code = 0; code < 8; ++code) {
    set_rights(2, 0x2001'0000, 10, static_cast<Rights>(code == 4 ? 0 : code));
    std::uint32_t passes = 0;
    if (verdict(load_word, 0x2001'0200) == 0) passes |= 1;
    if (verdict(store_word, 0x2001'0200) == 0) passes |= 2;
    if (verdict_of_user(load_word, 0x2001'0200) == 0) passes |= 4;
    if (verdict_of_user(store_word, 0x2001'0200) == 0) passes |= 8;
    note(passes);
  }
  take_regions_away();
}

// results[30] to [35]: addresses without a region, and the core's registers, which no region covers.
void probe_background() {
  constexpr std::uint32_t clocks = 0x4002'3800;
  let_everybody_run();
  protect(enable | default_map);
  note(verdict(load_word, clocks));
  note(verdict_of_user(load_word, clocks));
  protect(enable);
  note(verdict(load_word, clocks));
  set_rights(2, 0xE000'0000, 29, none);
  note(verdict(load_word, mpu_control));
  set_rights(2, 0xE000'0000, 29, all);
  note(verdict_of_user(load_word, mpu_control));
  note(word(0xE000ED90));
  take_regions_away();
}

// results[36] to [41]: fault handlers and FAULTMASK bypass the protection unless HFNMIENA is set.
void probe_masks() {
  set_rights(0, 0x2001'0000, 12, read_only);
  protect(enable | default_map);
  note(verdict(store_word, 0x2001'0000));
  asm volatile("cpsid f" ::: "memory");
  note(verdict(store_word, 0x2001'0000));
  asm volatile("cpsie f" ::: "memory");
  note(verdict(store_word, 0x2001'0000));
  // In HardFault, MemManage is first disabled, and then it cannot preempt.
  word(shcsr) = 6 << 16;
  mend = [] {
    word(0x2001'0000) = 0x600D;
    take_regions_away();
  };
  note(verdict(store_word, 0x2001'0000));
  note(word(0x2001'0000) == 0x2001'0000);  // the handler's store passed, then the repeated store of the probe
  word(shcsr) = 7 << 16;
  mend = nullptr;
  set_rights(0, 0x2001'0000, 12, read_only);
  protect(enable | default_map);
  set_handler(11, [] { note(verdict(store_word, 0x2001'0000)); });
  asm volatile("svc #0" ::: "memory");
  set_handler(11, supervisor_call);
  take_regions_away();
}

// results[42] to [44]: device memory requires aligned accesses. Peripheral registers in a region of normal memory
// allow unaligned accesses.
void probe_kinds() {
  set_rights(0, 0x2001'0000, 12, all, device);
  set_rights(1, 0x4002'0000, 12, all);
  word(rcc::ahb1enr) |= 1;
  protect(enable | default_map);
  note(verdict(load_word, 0x2001'0000));
  note(verdict(load_word, 0x2001'0002));
  note(verdict(load_word, gpio::a + gpio::idr - 2));
  take_regions_away();
}

// results[45] to [49]: the unit is enabled while FAULTMASK bypasses it. An unprivileged thread on the process stack is
// interrupted and continues unprivileged.
void probe_late_start_and_user() {
  set_rights(0, 0x2001'0000, 12, read_only);
  asm volatile("cpsid f" ::: "memory");
  protect(enable | default_map);
  note(verdict(store_word, 0x2001'0000));
  asm volatile("cpsie f" ::: "memory");
  take_regions_away();
  static std::uint32_t in_handler, stack_in_handler;
  constexpr std::uint32_t stack = 0x2001'1000;
  let_everybody_run();
  protect(enable | default_map);
  set_handler(11, [] { asm volatile("mrs %0, control\n mrs %1, psp" : "=r"(in_handler), "=r"(stack_in_handler)); });
  std::uint32_t of_user, stack_of_user;
  asm volatile("msr psp, %2\n mov r0, #3\n msr control, r0\n isb\n svc #0\n mrs %0, control\n mov %1, sp"
               : "=r"(of_user), "=r"(stack_of_user)
               : "r"(stack)
               : "r0", "r1", "r2", "r3", "r12", "lr", "memory");
  set_handler(11, supervisor_call);
  become_privileged();
  asm volatile("mov r0, #0\n msr control, r0\n isb" ::: "r0", "memory");
  note(in_handler);
  note(stack_in_handler - stack);
  note(of_user);
  note(stack_of_user - stack);
  take_regions_away();
}

}  // namespace

void run() {
  word(0xE000ED88) |= 0xF << 20;
  barrier();
  for (unsigned exception = 3; exception <= 6; ++exception) set_handler(exception, refusal);
  set_handler(11, supervisor_call);
  word(shcsr) = 7 << 16;
  probe_regions();
  probe_fetches();
  probe_rights();
  probe_background();
  probe_masks();
  probe_kinds();
  probe_late_start_and_user();
  results[0] = finished;
  // With HFNMIENA, FAULTMASK no longer bypasses the protection, and no handler can handle the fault.
  set_rights(0, 0x2001'0000, 12, read_only);
  protect(enable | default_map | above_cpu_faults_too);
  asm volatile("cpsid f" ::: "memory");
  store_word(0x2001'0000);
}
