// What the fault handler leaves for the next start: it lies in memory that start-up does not clear.
#pragma once

#include <cstdint>
#include <optional>

namespace inkwell::drivers {

/// Facts about a processor fault (ARMv7-M, "Fault handling").
struct CrashRecord {
  std::uint32_t exception;        ///< number of the exception: 2 NMI, 3 hard fault, from 16 on an unexpected interrupt
  std::uint32_t program_counter;  ///< 0 if the stack could not be read
  std::uint32_t link_register;
  std::uint32_t configurable_fault_status;  ///< CFSR
  std::uint32_t hard_fault_status;          ///< HFSR
  std::uint32_t fault_address;              ///< BFAR

  /// Nothing else raises the non-maskable interrupt (RM0090, "Clock security system").
  constexpr bool crystal_stopped() const { return exception == 2; }
};

/// Keeps a record over the reset that follows.
void leave_crash_record(const CrashRecord& record);

/// The record that the run before left, once. Memory after power-up holds anything, so it is checked.
std::optional<CrashRecord> take_crash_record();

}  // namespace inkwell::drivers
