// Exception numbers (ARMv7-M, B1.5.2) and interrupt positions (RM0090, table "Vector table for STM32F405xx/07xx").
#pragma once

namespace inkwell::virtual_board {

enum Exception : unsigned {
  exception_none = 0,
  exception_reset = 1,
  exception_nmi = 2,
  exception_hard_fault = 3,
  exception_memory_fault = 4,
  exception_bus_fault = 5,
  exception_usage_fault = 6,
  exception_svcall = 11,
  exception_debug = 12,
  exception_pendsv = 14,
  exception_systick = 15,
  exception_interrupt_0 = 16,
};

inline constexpr unsigned interrupt_positions = 82;
inline constexpr unsigned exception_numbers = exception_interrupt_0 + interrupt_positions;

inline constexpr unsigned voltage_detector_position = 1, converters_position = 18, otg_fs_position = 67;
constexpr unsigned exception_of(unsigned position) { return exception_interrupt_0 + position; }

}  // namespace inkwell::virtual_board
