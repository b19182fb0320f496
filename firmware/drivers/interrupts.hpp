// Lines of the interrupt controller. Each line belongs to one driver (PM0214, chapter NVIC).
#pragma once

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

/// Disables interrupts during the lifetime of this object. The lifetime must not exceed a few microseconds, except for
/// a sleep. A pending interrupt ends a sleep.
class InterruptsHeld {
 public:
  InterruptsHeld() { asm volatile("cpsid i" ::: "memory"); }
  ~InterruptsHeld() { asm volatile("cpsie i" ::: "memory"); }
  InterruptsHeld(const InterruptsHeld&) = delete;
  InterruptsHeld& operator=(const InterruptsHeld&) = delete;
};

/// Every interrupt handler calls finish_stores() last. If a handler returns during a store, the processor may run the
/// wrong interrupt (erratum 838869 of the Cortex-M4).
inline void finish_stores() { asm volatile("dsb" ::: "memory"); }

/// The PendSV handler runs after all interrupts and before the program continues (ARMv7-M, B1.5.6). Every interrupt can
/// preempt the PendSV handler.
struct CallAfterInterrupts {
  static void start() {
    constexpr std::uint32_t after_all_interrupts = 0xF0;
    registers::SCB::SHPR3::modify(registers::SCB::SHPR3::PRI_14(after_all_interrupts));
  }
  static void request() { registers::SCB::ICSR::write(registers::SCB::ICSR::PENDSVSET(1)); }
};

/// Interrupt line of a driver. No interrupt preempts another interrupt. Faults preempt all interrupts.
template <class Driver, Interrupt line>
struct InterruptLine {
  static void enable() {
    require_claim<Driver, interrupt(line)>();
    constexpr std::uint8_t after_cpu_faults = 0x10;
    registers::NVIC::IPR::write(position, after_cpu_faults);
    registers::NVIC::ISER::write(position / 32, 1u << position % 32);
  }

 private:
  static constexpr unsigned position = static_cast<unsigned>(line);
};

}  // namespace inkwell::drivers
