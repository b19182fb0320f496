// Small things that belong to the chip as a whole: reset and its cause, interrupts, identity.
#pragma once

#include <array>
#include <cstdint>

#include <registers/clock.hpp>
#include <registers/processor.hpp>

namespace inkwell::drivers {

/// Position in the vector table (RM0090, "Vector table for STM32F405xx").
enum class Interrupt : std::uint8_t { analog_converters = 18, usb = 67 };

/// `first` interrupts whatever runs: it is the control interrupt's alone.
enum class Priority : std::uint8_t { first = 0x00, last = 0xF0 };

inline void set_priority(Interrupt interrupt, Priority priority) {
  registers::NVIC::IPR::write(static_cast<unsigned>(interrupt), static_cast<std::uint8_t>(priority));
}

inline void enable(Interrupt interrupt) {
  const auto position = static_cast<unsigned>(interrupt);
  registers::NVIC::ISER::write(position / 32, 1u << position % 32);
}

inline void disable(Interrupt interrupt) {
  const auto position = static_cast<unsigned>(interrupt);
  registers::NVIC::ICER::write(position / 32, 1u << position % 32);
}

/// Flags of RCC_CSR: why the chip started.
struct ResetCause {
  std::uint32_t flags;
  bool watchdog() const { return registers::RCC::CSR::IWDGRSTF::from(flags) != 0; }
};

/// Reads the cause of the last reset and clears it, so that the next one stands alone.
inline ResetCause take_reset_cause() {
  const ResetCause cause{registers::RCC::CSR::read()};
  registers::RCC::CSR::modify(registers::RCC::CSR::RMVF(1));
  return cause;
}

[[noreturn]] inline void reset_chip() {
  constexpr std::uint32_t key = 0x05FA;
  asm volatile("dsb" ::: "memory");
  registers::SCB::AIRCR::write(registers::SCB::AIRCR::VECTKEY(key), registers::SCB::AIRCR::SYSRESETREQ(1));
  for (;;) asm volatile("dsb" ::: "memory");
}

/// The chip's unique identifier as 24 hexadecimal digits (RM0090, "Unique device ID register").
inline std::array<char, 24> unique_identifier() {
  std::array<char, 24> digits{};
  for (unsigned i = 0; i < digits.size(); ++i)
    digits[i] = "0123456789ABCDEF"[registers::SIGNATURE::U_ID::read(i / 8) >> (28 - i % 8 * 4) & 0xF];
  return digits;
}

/// Sleeps until an interrupt has been served.
inline void wait_for_interrupt() { asm volatile("wfi" ::: "memory"); }

}  // namespace inkwell::drivers
