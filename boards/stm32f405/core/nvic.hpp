// Exception states (enabled, pending, active) and priorities (ARMv7-M, B1.5 and B3.4).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include "boards/stm32f405/core/exception_numbers.hpp"
#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

/// Execution priority of thread mode. Lower values are more urgent.
inline constexpr int priority_lowest = 256;

struct Masks {
  bool primask = false, faultmask = false;
  std::uint32_t basepri = 0;
  bool are_open() const { return !primask && !faultmask && basepri == 0; }
};

class Nvic final : public InterruptController {
 public:
  static constexpr unsigned positions = interrupt_positions;
  static constexpr unsigned outside_source = 31;

  void reset();

  /// Sets one source of an interrupt line. Several peripherals or flags may share a line; `source` (0..31) identifies
  /// the peripheral or flag.
  void set_source(unsigned position, unsigned source, bool asserted);
  void set_level(unsigned position, bool asserted) override { set_source(position, outside_source, asserted); }

  void set_non_maskable(bool asserted) {
    non_maskable_ = asserted;
    if (asserted) pend(exception_nmi);
  }
  /// While `lost` is true, the exception does not reach the core.
  void lose(unsigned exception, bool lost) {
    assign(lost_, exception, lost);
    changed_ = true;
  }

  /// While `late` is true, the Nvic object calls `on_held` when the exception becomes pending. The exception then waits
  /// for let_go().
  void hold_back(unsigned exception, bool late) { assign(late_, exception, late); }
  void let_go(unsigned exception) {
    assign(held_, exception, false);
    changed_ = true;
  }
  std::function<void(unsigned exception)> on_held;

  std::uint32_t read(std::uint32_t offset) const;  ///< offset from ISER0
  void write(std::uint32_t offset, std::uint32_t value, unsigned size);

  void pend(unsigned exception);
  void unpend(unsigned exception);
  bool pending(unsigned exception) const { return test(pending_, exception); }
  bool active(unsigned exception) const { return test(active_, exception); }
  void set_active(unsigned exception, bool is_active) { assign(active_, exception, is_active); }
  void enable(unsigned exception, bool is_enabled) {
    assign(enabled_, exception, is_enabled);
    changed_ = true;
  }
  bool enabled(unsigned exception) const { return test(enabled_, exception); }
  unsigned active_count() const;

  std::uint8_t priority(unsigned exception) const { return priority_[exception]; }
  void set_priority(unsigned exception, std::uint8_t value) {
    priority_[exception] = value & 0xF0;
    changed_ = true;
  }
  void set_priority_group(unsigned group) {
    group_ = group;
    changed_ = true;
  }
  unsigned priority_group() const { return group_; }

  /// Group priority of an exception; -1 for HardFault, -2 for NMI.
  int group_priority(unsigned exception) const;
  /// Execution priority with the masks applied.
  int execution_priority(const Masks& masks) const;
  /// Returns the exception to enter now, or exception_none.
  unsigned next(const Masks& masks) const;
  /// Returns the most urgent exception that is pending and enabled, or exception_none. The execution priority has no
  /// effect.
  unsigned most_urgent() const;
  /// Makes a pending exception active. If the interrupt line stays asserted, the interrupt becomes pending again when
  /// the handler returns.
  void enter(unsigned exception);
  void leave(unsigned exception);

  /// Returns true if a pending state, a priority or an enable bit has changed since the last call.
  bool take_changed() { return std::exchange(changed_, false); }
  bool changed() const { return changed_; }
  /// Returns true if an exception became pending since the last call (for SEVONPEND).
  bool take_newly_pending() { return std::exchange(newly_pending_, false); }

 private:
  using Bits = std::array<std::uint64_t, 2>;
  static bool test(const Bits& bits, unsigned n) { return (bits[n >> 6] >> (n & 63) & 1) != 0; }
  static void assign(Bits& bits, unsigned n, bool value) {
    const std::uint64_t mask = std::uint64_t{1} << (n & 63);
    bits[n >> 6] = value ? bits[n >> 6] | mask : bits[n >> 6] & ~mask;
  }
  std::uint32_t word_of(const Bits& bits, unsigned index) const;

  Bits pending_{}, active_{}, enabled_{};
  Bits lost_{}, late_{};  ///< not cleared by a reset
  Bits held_{};
  bool non_maskable_ = false;
  std::array<std::uint8_t, exception_numbers> priority_{};
  std::array<std::uint32_t, positions> level_{};
  unsigned group_ = 0;
  bool changed_ = false;
  bool newly_pending_ = false;
};

}  // namespace inkwell::virtual_board
