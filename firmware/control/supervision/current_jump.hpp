// Detects motor current changes that a winding cannot cause.
//
// The inductance of a winding limits the rate of change of its current. An open circuit or a failed sensor changes the
// current reading within one control period. MotorCheck needs milliseconds to detect an open circuit or a failed
// sensor. The jump check needs a single reading.
#pragma once

#include <cmath>

#include "firmware/control/signal_path/vector.hpp"
#include "firmware/control/supervision/motor_check.hpp"

namespace inkwell::control {

struct CurrentJump {
  /// Tolerated unexplained current change per control period. In simulation, healthy motors reached half of this
  /// tolerance.
  static constexpr float tolerance_A = 0.3f;
};

/// Replaces `current_A` by `now_A` and returns the change.
inline float replace(float& current_A, float now_A) {
  const float change_A = now_A - current_A;
  current_A = now_A;
  return change_A;
}

/// Returns true if at least one of the three current changes may be a jump. If the result is true, is_jump() must check
/// each change.
inline bool is_large(float first_A, float second_A, float third_A) {
  return first_A * first_A + second_A * second_A + third_A * third_A >
         CurrentJump::tolerance_A * CurrentJump::tolerance_A;
}

/// Returns true if neither the current loop nor the speed explains a current change. A current loop changes the current
/// by about `error_A`, the error of the previous period. A back EMF changes a current by at most back EMF / resistance.
inline bool is_jump(float change_A, float error_A, float back_emf_V, const Resistance& resistance) {
  const float beyond_A = std::fabs(change_A) - CurrentJump::tolerance_A - std::fabs(error_A);
  return beyond_A * resistance.value_ohm > std::fabs(back_emf_V);
}

}  // namespace inkwell::control
