// Shared state of all parts of the chip.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "boards/stm32f405/core/address_space.hpp"
#include "boards/stm32f405/core/chip_options.hpp"
#include "boards/stm32f405/core/clock.hpp"
#include "boards/stm32f405/core/counters.hpp"
#include "boards/stm32f405/core/debug_halt.hpp"
#include "boards/stm32f405/core/debugging.hpp"
#include "boards/stm32f405/core/log.hpp"
#include "boards/stm32f405/core/memory_map.hpp"
#include "boards/stm32f405/core/memory_protection.hpp"
#include "boards/stm32f405/core/nvic.hpp"
#include "boards/stm32f405/core/timeline.hpp"
#include "boards/stm32f405/core/violations.hpp"

namespace inkwell::virtual_board {

/// Reserved stack space for FPU registers, and state of the interrupted code.
struct FloatFrame {
  std::uint32_t address;
  int priority;  ///< execution priority
  bool privileged, in_thread;
};

struct Machine {
  Machine(Circuit& the_circuit, const ChipOptions& the_options, AddressSpace& the_memory, const CodePosition& code)
      : circuit(the_circuit),
        options(the_options),
        log(the_options.log),
        violations(log, timeline, code),
        memory(the_memory) {}

  Circuit& circuit;
  ChipOptions options;
  Log log;
  Violations violations;
  Timeline timeline;
  AddressSpace& memory;
  MemoryProtection memory_protection;
  Nvic nvic;
  ClockTree clocks;
  Debugging debugging;
  DebugHalt debug_halt;
  std::vector<ClockUser*> clock_users;
  /// Called after a write to RAM that the processor's store instructions have not made: DMA and bit-band writes.
  std::function<void(std::uint32_t address, std::uint32_t bytes)> on_ram_write;

  double supply_V = logic_supply_V, analog_supply_V = logic_supply_V;
  bool supply_is_low = false;        ///< the brown-out reset is active
  bool flash_is_misread = false;     ///< too few wait states for HCLK
  bool traps_zero_division = false;  ///< CCR.DIV_0_TRP
  bool clock_is_lost = false;        ///< the crystal that clocks the core has stopped without detection
  Ticks core_stalls_until = 0;       ///< the core does nothing until this time
  Ticks thread_stalls_until = 0;     ///< thread mode does nothing until this time, unless exceptions are masked
  bool sleep_counts_cycles = false;  ///< DBGMCU_CR.DBG_SLEEP keeps HCLK running in sleep
  /// Pending reset with its cause.
  bool reset_requested = false;
  ResetCause reset_cause = ResetCause::pin;
  void request_reset(ResetCause cause) {
    if (!reset_requested) reset_cause = cause;
    reset_requested = true;
  }

  Ticks last_advance = 0;
  /// Largest interval between two updates of the circuit.
  static constexpr Ticks advance_period = 50 * (ticks_per_s / 1'000'000);
  /// Maximum age of digital inputs when firmware reads the inputs.
  static constexpr Ticks input_age_limit = 5 * (ticks_per_s / 1'000'000);
  void advance_circuit(Ticks at_least) {
    const Ticks now = timeline.now();
    if (now - last_advance < at_least) return;
    last_advance = now;
    circuit.advance(now);
  }
  /// In fast mode, a DMA stream without interrupts may delay its memory writes up to this limit. The delay reduces the
  /// number of processor stops.
  Ticks transfer_lag() const { return options.mode == Mode::exact ? 0 : 10 * (ticks_per_s / 1'000'000); }
};

/// Returns `old` after a write of `size` bytes of `value` at `offset`.
constexpr std::uint32_t merge(std::uint32_t old, std::uint32_t value, std::uint32_t offset, unsigned size) {
  if (size == 4) return value;
  const unsigned shift = 8 * (offset & 3);
  const std::uint32_t mask = (size == 1 ? 0xFFu : 0xFFFFu) << shift;
  return (old & ~mask) | (value << shift & mask);
}

}  // namespace inkwell::virtual_board
