// Lines of the interrupt controller, each of one driver (PM0214, chapter NVIC).
#pragma once

#include <drivers/claims.hpp>
#include <registers/peripherals.hpp>

namespace inkwell::drivers {

/// `first` interrupts whatever runs: it is the control interrupt's alone.
enum class Priority : std::uint8_t { first = 0x00, last = 0xF0 };

/// No interrupt comes while it lives, which may be a microsecond, or a sleep that an interrupt ends.
class InterruptsHeld {
 public:
  InterruptsHeld() { asm volatile("cpsid i" ::: "memory"); }
  ~InterruptsHeld() { asm volatile("cpsie i" ::: "memory"); }
  InterruptsHeld(const InterruptsHeld&) = delete;
  InterruptsHeld& operator=(const InterruptsHeld&) = delete;
};

/// A line as its driver has it.
template <class Driver, Interrupt line>
struct InterruptLine {
  static void set_priority(Priority priority) {
    require_claim<Driver, interrupt(line)>();
    registers::NVIC::IPR::write(position, static_cast<std::uint8_t>(priority));
  }
  static void enable() {
    require_claim<Driver, interrupt(line)>();
    registers::NVIC::ISER::write(position / 32, 1u << position % 32);
  }
  static void disable() {
    require_claim<Driver, interrupt(line)>();
    registers::NVIC::ICER::write(position / 32, 1u << position % 32);
  }
  static bool is_enabled() { return (registers::NVIC::ISER::read(position / 32) >> position % 32 & 1u) != 0; }

 private:
  static constexpr unsigned position = static_cast<unsigned>(line);
};

}  // namespace inkwell::drivers
