// Measures the force of the motors at the probe. The measurement does not require a hand.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include "boards/virtual/plant/arm_dynamics.hpp"

namespace inkwell::virtual_board {

/// Measures the force F that satisfies J^T F = tau. The mean over one control period removes the current ripple. The
/// mean over one millisecond removes short pushes. Steps in which no leg is driven high are excluded, because the
/// motors only brake.
class MotorForceMeter {
 public:
  static constexpr unsigned steps_per_period = 3, steps_per_ms = 60;

  /// Resets the peaks. The averages are not reset, so the first averages include steps before this call.
  void start() { peak_N_ = peak_over_ms_N_ = 0.0; }
  double peak_N() const { return peak_N_; }
  double peak_over_ms_N() const { return peak_over_ms_N_; }

  /// Adds one step. `is_driven` is true if a leg was driven high within the last period. With a nearly singular
  /// Jacobian the torques do not define a force, so the step is skipped.
  void step(const Vector3& torque_Nm, const Matrix3& jacobian_m, bool is_driven) {
    constexpr double singular_m3 = 1e-5;  // an Omni has 2e-3 in the middle of its reach
    const bool is_singular = std::abs(jacobian_m.determinant()) < singular_m3;
    if (!is_driven || is_singular) {
      period_N_.count = ms_N_.count = 0;
      return;
    }
    if (!period_N_.add(jacobian_m.transpose().inverse() * torque_Nm)) return;
    const double force_N = Vector3(period_N_.sum / steps_per_period).norm();
    peak_N_ = std::max(peak_N_, force_N);
    if (ms_N_.add(force_N)) peak_over_ms_N_ = std::max(peak_over_ms_N_, ms_N_.sum / steps_per_ms);
  }

 private:
  /// Sum of the last `length` values of an uninterrupted sequence.
  template <class Value, unsigned length>
  struct Sum {
    std::array<Value, length> values;
    Value sum;
    unsigned long count = 0;

    /// Adds a value. Returns true if the sum contains `length` values.
    bool add(const Value& value) {
      Value& oldest = values[count % length];
      if (count == 0)
        sum = value;
      else if (count < length)
        sum += value;
      else
        sum += value - oldest;
      oldest = value;
      return ++count >= length;
    }
  };
  Sum<Vector3, steps_per_period> period_N_;
  Sum<double, steps_per_ms> ms_N_;
  double peak_N_ = 0.0, peak_over_ms_N_ = 0.0;
};

}  // namespace inkwell::virtual_board
