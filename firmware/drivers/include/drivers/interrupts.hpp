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

/// A line as its driver has it. There is one, and faults interrupt it.
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
