// How hard the bridges have the motors press with the probe, whether or not a hand is there to feel it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <plant/arm_dynamics.hpp>

namespace inkwell::virtual_board {

/// The force F with J^T F = tau. In the mean over a control period, because what a bridge's current swings by within
/// one is neither asked for nor felt; and how large that was in the mean over a millisecond, of which a hand feels more
/// than of a shorter push. An arm that is braked, or whose currents fade, resists by its own motion and is left out.
class MotorForceMeter {
 public:
  static constexpr unsigned steps_per_period = 3, steps_per_ms = 60;

  /// What is told from now on may reach back by as much as it is a mean over.
  void start() { peak_N_ = peak_over_ms_N_ = 0.0; }
  double peak_N() const { return peak_N_; }
  double peak_over_ms_N() const { return peak_over_ms_N_; }

  /// A step later; whether a leg was at the supply within the last period. Where the arm cannot move the probe in every
  /// direction no force stands for the torques, so that they are left out.
  void step(const Vector3& torque_Nm, const Matrix3& jacobian_m, bool is_driven) {
    constexpr double singular_m3 = 1e-5;  // the middle of an Omni's reach has 2e-3
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
  /// Of the newest values in a row.
  template <class Value, unsigned length>
  struct Sum {
    std::array<Value, length> values;
    Value sum;
    unsigned long count = 0;

    /// Whether there are as many as it is of.
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
