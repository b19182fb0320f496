// Current control of one motor: a PI controller with anti-windup (paper, section 3.5, after Eq. 15).
//
// The controller's zero R/L cancels the motor's electrical pole when the integral gain is R times and the
// proportional gain L times the wanted bandwidth. The integral is taken by the trapezoidal rule, because
// at 50 us against L/R = 109 us either rectangle would put the discrete zero well beside the pole.
#pragma once

#include <algorithm>
#include <cmath>

#include <control/motor_watch.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

struct CurrentLoopGains {
  float proportional_V_per_A;
  float half_integral_V_per_A;  ///< integral gain times half a control period: the trapezoidal rule's weight
  float voltage_limit_V;
};

/// What one loop remembers. Zero while its bridge is off.
struct CurrentLoop {
  float integral_V = 0.0f;
  float error_A = 0.0f;  ///< of the period before
};

struct CurrentLoopStep {
  CurrentLoop loop;
  float voltage_V;
};

/// What a loop's voltage may be.
struct VoltageRange {
  float least_V, most_V;
};

/// What of +-bound_V a motor needs at most for `most_A` to either side, while it turns with about `back_emf_V` and its
/// bridge takes `bridge_V`. No voltage is always within, so that a speed that is wrong drives nothing.
inline VoltageRange voltage_range(float most_A, const Resistance& resistance, float back_emf_V, float bridge_V,
                                  float bound_V) {
  const float half_V =
      resistance.with_room_ohm() * most_A + bridge_V + MotorWatch::bearable_part_of_back_emf * std::fabs(back_emf_V);
  return {std::max(std::min(back_emf_V - half_V, 0.0f), -bound_V),
          std::min(std::max(back_emf_V + half_V, 0.0f), bound_V)};
}

/// One period: the voltage for the next period, within `range`. While the voltage is at its bound the integral does
/// not grow further towards it.
CurrentLoopStep regulate(const CurrentLoop& loop, float reference_A, float current_A, const CurrentLoopGains& gains,
                         const VoltageRange& range);

}  // namespace inkwell::control
