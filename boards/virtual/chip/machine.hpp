// What the parts of the chip know of each other.
#pragma once

#include <array>
#include <chip/chip.hpp>
#include <cstdint>
#include <vector>

#include <chip/memory.hpp>
#include "clock.hpp"
#include "debug_halt.hpp"
#include "debugging.hpp"
#include "log.hpp"
#include "memory_protection.hpp"
#include "nvic.hpp"
#include "timeline.hpp"
#include "violations.hpp"

namespace inkwell::virtual_board {

class Adcs;
class Dma;
class Exti;
class FlashController;
class Pins;
class PowerControl;
class Processor;
class Rcc;
class Timers;

/// Clocks as they run now (RM0090, figure "Clock tree").
struct ClockTree {
  Clock hclk, pclk1, pclk2, timer1, timer2, usb, low_speed_internal;
  Clocks frequencies{};
  bool operator==(const ClockTree& other) const {
    return hclk == other.hclk && pclk1 == other.pclk1 && pclk2 == other.pclk2 && timer1 == other.timer1 &&
           timer2 == other.timer2 && usb == other.usb;
  }
};

/// Room that an exception has left for the FPU's registers, and what was interrupted.
struct FloatFrame {
  std::uint32_t address;
  int priority;  ///< of its execution
  bool privileged, in_thread;
};

/// A part that counts cycles of a clock which firmware can change.
class ClockUser {
 public:
  virtual ~ClockUser() = default;
  virtual void before_clock_change() = 0;  ///< settle with the old clock up to now
  virtual void after_clock_change() = 0;   ///< go on from now with the new one
};

struct Machine {
  Machine(Circuit& the_circuit, const ChipOptions& the_options)
      : circuit(the_circuit), options(the_options), log(the_options.log) {}

  Circuit& circuit;
  ChipOptions options;
  Log log;
  Violations violations{*this};
  Timeline timeline;
  Memory memory;
  MemoryProtection memory_protection;
  Nvic nvic;
  ClockTree clocks;
  Debugging debugging;
  DebugHalt debug_halt;
  std::vector<ClockUser*> clock_users;

  Adcs* adcs = nullptr;
  Dma* dma = nullptr;
  Exti* exti = nullptr;
  FlashController* flash = nullptr;
  Pins* pins = nullptr;
  PowerControl* power = nullptr;
  Processor* processor = nullptr;
  Rcc* rcc = nullptr;
  Timers* timers = nullptr;

  double supply_V = logic_supply_V, analog_supply_V = logic_supply_V;
  bool supply_is_low = false;        ///< the brown-out reset holds the chip
  bool flash_is_misread = false;     ///< too few wait states for HCLK
  bool traps_zero_division = false;  ///< CCR.DIV_0_TRP
  bool clock_is_lost = false;        ///< the crystal that the core runs from has stopped, and nobody noticed
  Ticks core_stalls_until = 0;       ///< the core makes nothing of its clock until then
  Ticks thread_stalls_until = 0;     ///< nor of thread mode, unless exceptions are held back
  bool sleep_counts_cycles = false;  ///< DBGMCU_CR.DBG_SLEEP keeps HCLK on in sleep
  /// A reset that is due at the next chance, by cause.
  bool reset_requested = false;
  ResetCause reset_cause = ResetCause::pin;
  void request_reset(ResetCause cause) {
    if (!reset_requested) reset_cause = cause;
    reset_requested = true;
  }

  Ticks last_advance = 0;
  /// The circuit's time must follow at least every 50 us.
  static constexpr Ticks advance_period = 50 * (ticks_per_s / 1'000'000);
  /// What firmware reads of the circuit's digital signals is not older than this.
  static constexpr Ticks input_age_limit = 5 * (ticks_per_s / 1'000'000);
  void advance_circuit(Ticks at_least) {
    const Ticks now = timeline.now();
    if (now - last_advance < at_least) return;
    last_advance = now;
    circuit.advance(now);
  }
  /// Without interrupts, memory written by DMA may lag by this in fast mode; it saves stops of the processor.
  Ticks transfer_lag() const { return options.mode == Mode::exact ? 0 : 10 * (ticks_per_s / 1'000'000); }
};

/// Replaces the bytes of a register that an access of `size` bytes at `offset` touches.
constexpr std::uint32_t merge(std::uint32_t old, std::uint32_t value, std::uint32_t offset, unsigned size) {
  if (size == 4) return value;
  const unsigned shift = 8 * (offset & 3);
  const std::uint32_t mask = (size == 1 ? 0xFFu : 0xFFFFu) << shift;
  return (old & ~mask) | (value << shift & mask);
}

}  // namespace inkwell::virtual_board
