// Lines of the interrupt controller, each of one driver (PM0214, chapter NVIC).
#pragma once

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

/// No interrupt comes while it lives, which may be some microseconds, or a sleep that an interrupt ends.
class InterruptsHeld {
 public:
  InterruptsHeld() { asm volatile("cpsid i" ::: "memory"); }
  ~InterruptsHeld() { asm volatile("cpsie i" ::: "memory"); }
  InterruptsHeld(const InterruptsHeld&) = delete;
  InterruptsHeld& operator=(const InterruptsHeld&) = delete;
};

/// Last of every handler. While one returns with a store under way, the processor may clear an interrupt that comes
/// then and run another in its place (erratum 838869 of the Cortex-M4; RM0090's chip has that core).
inline void finish_stores() { asm volatile("dsb" ::: "memory"); }

/// A handler that comes when every interrupt has been served, before the program goes on, and that each of them
/// interrupts (PendSV: ARMv7-M, B1.5.6).
struct CallBehindInterrupts {
  static void start() {
    constexpr std::uint32_t behind_all = 0xF0;
    registers::SCB::SHPR3::modify(registers::SCB::SHPR3::PRI_14(behind_all));
  }
  static void ask() { registers::SCB::ICSR::write(registers::SCB::ICSR::PENDSVSET(1)); }
};

/// A line as its driver has it. None interrupts another, and faults interrupt each.
template <class Driver, Interrupt line>
struct InterruptLine {
  static void enable() {
    require_claim<Driver, interrupt(line)>();
    constexpr std::uint8_t behind_faults = 0x10;
    registers::NVIC::IPR::write(position, behind_faults);
    registers::NVIC::ISER::write(position / 32, 1u << position % 32);
  }

 private:
  static constexpr unsigned position = static_cast<unsigned>(line);
};

}  // namespace inkwell::drivers
