// Current control of one motor: PI controller with anti-windup (paper, section 3.5, after Eq. 15).
//
// The controller zero at R/L cancels the electrical pole of the motor. The integral gain is therefore R times the
// desired bandwidth, and the proportional gain is L times this bandwidth. The integral uses the trapezoidal rule. A
// rectangular rule would move the controller zero away from the motor pole.
#pragma once

#include "firmware/control/signal_path/vector.hpp"

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

/// Computes the voltage for the next period, within `range`. The integral does not change while it would drive the
/// voltage beyond `range`.
CurrentLoopStep regulate(const CurrentLoop& loop, float reference_A, float current_A, const CurrentLoopGains& gains,
                         const VoltageRange& range);

}  // namespace inkwell::control
