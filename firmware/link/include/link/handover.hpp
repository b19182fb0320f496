// A value that the main loop makes and the control interrupt uses.
#pragma once

#include <array>
#include <cstdint>

#include <link/shared.hpp>

namespace inkwell::link {

/// Two places: the interrupt works with one, the main loop prepares the next value in the other. The interrupt alone
/// swaps them, so a value is used whole or not at all.
template <class T>
class Handover {
 public:
  constexpr Handover() = default;
  constexpr explicit Handover(const T& first) : places_{first, T{}} {}

  // ---- main loop ----

  /// Where the next value is made; null while the interrupt has not taken the one before.
  T* next() { return offered_.load() ? nullptr : &places_[used_ ^ 1u]; }
  /// Whether a value waits to be taken; while none does, used() stays the same.
  bool is_offered() const { return offered_.load(); }
  /// What stands in next() is for the interrupt from now on.
  void offer() { offered_.store(true); }

  // ---- control interrupt ----

  /// Swaps if there is a value to take, and tells whether it did.
  bool take() {
    if (!offered_.load()) return false;
    used_ ^= 1u;
    offered_.store(false);
    return true;
  }
  const T& used() const { return places_[used_]; }

 private:
  std::array<T, 2> places_{};
  std::uint32_t used_ = 0;  ///< written by the interrupt, and only while `offered_`
  Shared<bool> offered_{false};
};

}  // namespace inkwell::link
