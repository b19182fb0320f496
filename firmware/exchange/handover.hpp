// Handover of a value from the main loop to the control interrupt.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/exchange/shared.hpp"

namespace inkwell::link {

/// Double buffer. The interrupt uses one slot while the main loop prepares the next value in the other slot. Only the
/// interrupt swaps the slots, so that the interrupt never reads an incomplete value.
template <class T>
class Handover {
 public:
  constexpr Handover() = default;
  constexpr explicit Handover(const T& first) : slots_{first, T{}} {}

  // ---- main loop ----

  /// Returns the slot for the next value. Returns null until the interrupt has accepted the previous value.
  T* next() { return offered_.load() ? nullptr : &slots_[used_ ^ 1u]; }
  /// Withdraws a value that the interrupt has not accepted, and returns the slot for the next value.
  T& withdraw() {
    offered_.store(false);
    return slots_[used_ ^ 1u];
  }
  /// Returns true if a value has been offered but not accepted. While is_offered() returns false, used() does not
  /// change.
  bool is_offered() const { return offered_.load(); }
  /// Offers the value in next() to the interrupt.
  void offer() { offered_.store(true); }

  // ---- control interrupt ----

  /// Swaps the slots if a value was offered. Returns true if the slots were swapped.
  bool swap_if_offered() {
    if (!offered_.load()) return false;
    used_ ^= 1u;
    offered_.store(false);
    return true;
  }
  const T& used() const { return slots_[used_]; }
  /// The interrupt may change the value that it uses.
  T& used() { return slots_[used_]; }

 private:
  std::array<T, 2> slots_{};
  std::uint32_t used_ = 0;  ///< written by the interrupt, and only while `offered_` is true
  Shared<bool> offered_{false};
};

}  // namespace inkwell::link
