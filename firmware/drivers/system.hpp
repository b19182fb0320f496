// Functions for reset, reset cause, sleep and identity of the chip.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/drivers/interrupts.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

/// Flags of RCC_CSR for the cause of the last reset.
struct ResetCause {
  std::uint32_t flags;
  bool power_on() const { return registers::RCC::CSR::PORRSTF::from(flags) != 0; }
  /// Returns true if the supply fell below the brown-out level and rose again. Returns false at power-on, although
  /// power-on sets the same flag.
  bool brown_out() const { return registers::RCC::CSR::BORRSTF::from(flags) != 0 && !power_on(); }
  bool watchdog() const { return registers::RCC::CSR::IWDGRSTF::from(flags) != 0; }
};

/// Reads and clears the reset flags, so that the next boot finds only new flags.
inline ResetCause take_reset_cause() {
  const ResetCause cause{registers::RCC::CSR::read()};
  registers::RCC::CSR::modify(registers::RCC::CSR::RMVF(1));
  return cause;
}

/// SYSCFG_MEMRMP.MEM_MODE after a reset while the boot pins select the boot loader.
inline constexpr std::uint32_t boot_loader_mode = 0b01;

/// Maps SRAM1 to address 0 until the next reset (RM0090, SYSCFG_MEMRMP and "Memory map"). Returns the previous value of
/// MEM_MODE, which is the selection of the boot pins after a reset.
inline std::uint32_t read_boot_mode_and_remap_sram1() {
  using registers::SYSCFG;
  registers::RCC::APB2ENR::modify(registers::RCC::APB2ENR::SYSCFGEN(1));
  static_cast<void>(registers::RCC::APB2ENR::read());  // erratum "Delay after an RCC peripheral clock enabling"
  const std::uint32_t boot_mode = SYSCFG::MEMRMP::MEM_MODE::read();
  constexpr std::uint32_t embedded_sram = 0b11;
  SYSCFG::MEMRMP::write(SYSCFG::MEMRMP::MEM_MODE(embedded_sram));
  static_cast<void>(SYSCFG::MEMRMP::read());  // waits until the write is complete
  asm volatile("dsb\n isb" ::: "memory");
  registers::RCC::APB2ENR::modify(registers::RCC::APB2ENR::SYSCFGEN(0));
  return boot_mode;
}

[[noreturn]] inline void reset_chip() {
  constexpr std::uint32_t key = 0x05FA;
  asm volatile("dsb" ::: "memory");
  registers::SCB::AIRCR::write(registers::SCB::AIRCR::VECTKEY(key), registers::SCB::AIRCR::SYSRESETREQ(1));
  for (;;) asm volatile("dsb" ::: "memory");
}

/// Unique identifier of the chip as 24 hexadecimal digits (RM0090, "Unique device ID register").
inline std::array<char, 24> unique_identifier() {
  std::array<char, 24> digits{};
  for (unsigned i = 0; i < digits.size(); ++i)
    digits[i] = "0123456789ABCDEF"[registers::SIGNATURE::U_ID::read(i / 8) >> (28 - i % 8 * 4) & 0xF];
  return digits;
}

/// Sleeps until an interrupt has been served. Returns without a sleep if work is already pending. Interrupts are
/// disabled during the check. A pending interrupt ends the sleep immediately. An interrupt between check and sleep
/// cannot be missed.
template <class Question>
void sleep_unless(Question has_work) {
  const InterruptsHeld held;
  if (!has_work()) asm volatile("wfi" ::: "memory");
}

}  // namespace inkwell::drivers
