// The installed force law from period to period: its time and its memory.
#pragma once

#include <cstdint>

#include <control/installed_force_law.hpp>

namespace inkwell::control {

class FeltForceLaw {
 public:
  FeltForceLaw() { reset_force_law(memory_); }

  /// One period in which the law is felt; `probe` is given its time. What comes back may be any number or none.
  const Vector3& force_N(Probe& probe, const ForceLawValues& values) {
    probe.periods = periods_++;
    step_force_law(probe, values, memory_, force_N_);
    return force_N_;
  }

  /// One period in which it is not felt: the next time it begins anew.
  void rest() {
    if (periods_ != 0) reset_force_law(memory_);
    periods_ = 0;
  }

  float signal(std::size_t place) const { return memory_.signals[place]; }

 private:
  std::uint32_t periods_ = 0;  ///< since it is felt
  Vector3 force_N_;
  ForceLawMemory memory_;
};

}  // namespace inkwell::control
