// What happens when the processor cannot go on: bridges off, a record, a restart.
#include <drivers/bridges_off.hpp>
#include <drivers/crash_record.hpp>
#include <drivers/system.hpp>
#include <registers/peripherals.hpp>

#include "handlers.hpp"
#include "memory.hpp"

namespace inkwell::application {

/// Switches the motors off with three stores before it trusts anything else, the stack included: that may be what is
/// broken. Then the record is made on the lowest 256 bytes of the stack, which nobody uses
/// unless the stack has overflowed. No interrupt comes between: it has the priority of a hard fault. A second fault in
/// here locks the processor up until the watchdog resets it.
extern "C" [[gnu::naked]] void fault_handler() {
  using namespace drivers;
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
      "ldr r1, =stack_bottom + 256 \n"
      "mov sp, r1 \n"
      "b record_fault \n"
      ".ltorg \n" ::[enable_address] "i"(bridge_enable_low.address),
      [enable_low] "i"(bridge_enable_low.value), [legs_a_address] "i"(legs_a_off.address),
      [legs_b_address] "i"(legs_b_off.address), [off] "i"(outputs_off));
}

/// `frame` is what the processor pushed on entry: r0 to r3, r12, lr, pc, status.
extern "C" [[noreturn, gnu::used]] void record_fault(const std::uint32_t* frame) {
  using registers::SCB;
  constexpr std::uint32_t frame_bytes = 32, link_register = 5, program_counter = 6;
  const auto address = reinterpret_cast<std::uint32_t>(frame);
  const bool readable = address % 4 == 0 && address >= reinterpret_cast<std::uint32_t>(stack_bottom) &&
                        address + frame_bytes <= reinterpret_cast<std::uint32_t>(stack_top);

  std::uint32_t exception = 0;
  asm volatile("mrs %0, ipsr" : "=r"(exception));
  drivers::leave_crash_record({exception, readable ? frame[program_counter] : 0, readable ? frame[link_register] : 0,
                               SCB::CFSR::read(), SCB::HFSR::read(), SCB::BFAR::read()});
  drivers::reset_chip();
}

}  // namespace inkwell::application
