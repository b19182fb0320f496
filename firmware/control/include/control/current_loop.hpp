// Current control of one motor: PI controller with anti-windup (paper, section 3.5, after Eq. 15).
//
// The controller zero at R/L cancels the electrical pole of the motor. The integral gain is therefore R times the
// desired bandwidth, and the proportional gain is L times this bandwidth. The integral uses the trapezoidal rule. At 50
// us and L/R = 109 us, a rectangular rule would move the discrete zero away from the pole.
#pragma once

#include <algorithm>
#include <cmath>

#include <control/motor_watch.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

struct CurrentLoopGains {
  float proportional_V_per_A;
  float half_integral_V_per_A;  ///< integral gain times half a control period: weight of the trapezoidal rule
  float voltage_limit_V;
};

/// State of one current loop. The state is zero while the bridge is off.
struct CurrentLoop {
  float integral_V = 0.0f;
  float error_A = 0.0f;  ///< of the previous period
};

struct CurrentLoopStep {
  CurrentLoop loop;
  float voltage_V;
};

struct VoltageRange {
  float least_V, most_V;
};

/// Returns the voltage range of a motor for currents up to +-`most_A`. The range is limited to +-`bound_V`.
/// `back_emf_V` is the approximate back EMF of the motor, and `bridge_V` is the voltage drop of the bridge. The range
/// always contains 0 V, so that a wrong speed value cannot drive the motor.
inline VoltageRange voltage_range(float most_A, const Resistance& resistance, float back_emf_V, float bridge_V,
                                  float bound_V) {
  const float half_V =
      resistance.with_room_ohm() * most_A + bridge_V + MotorWatch::tolerated_part_of_back_emf * std::fabs(back_emf_V);
  return {std::max(std::min(back_emf_V - half_V, 0.0f), -bound_V),
          std::min(std::max(back_emf_V + half_V, 0.0f), bound_V)};
}

/// Computes the voltage for the next period, within `range`. While the voltage is at a bound of the range, the integral
/// does not change towards this bound.
CurrentLoopStep regulate(const CurrentLoop& loop, float reference_A, float current_A, const CurrentLoopGains& gains,
                         const VoltageRange& range);

}  // namespace inkwell::control
