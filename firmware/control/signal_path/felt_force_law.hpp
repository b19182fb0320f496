// State and run time of the installed force law.
#pragma once

#include <cstdint>

#include "firmware/control/signal_path/installed_force_law.hpp"

namespace inkwell::control {

class FeltForceLaw {
 public:
  FeltForceLaw() { reset_force_law(memory_); }

  /// Sets `probe.periods` and runs one period of the law. The returned force may be infinite or NaN.
  const Vector3& force_N(Probe& probe, const ForceLawValues& values) {
    probe.periods = periods_++;
    step_force_law(probe, values, memory_, force_N_);
    return force_N_;
  }

  /// Call this function in each period in which the law does not run. The law restarts from its initial state after
  /// this call.
  void reset() {
    if (periods_ != 0) reset_force_law(memory_);
    periods_ = 0;
  }

  float signal(std::size_t index) const { return memory_.signals[index]; }

 private:
  std::uint32_t periods_ = 0;  ///< number of periods since the law became active
  Vector3 force_N_;
  ForceLawMemory memory_;
};

}  // namespace inkwell::control
