// Detects changes of a motor current that a winding cannot cause.
//
// The inductance of a winding limits the rate of its current. An open motor or bridge leg ends the current within one
// control period, and a failed sensor changes its reading instantly. The motor equation (MotorWatch) needs milliseconds
// to detect such a failure; this check needs a single reading.
#pragma once

#include <cmath>

#include <control/motor_watch.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

struct CurrentJump {
  /// Tolerated change per control period, in addition to an explained change. In simulation healthy motors reached half
  /// of this value while a program reversed a force of 7 N every millisecond.
  static constexpr float bearable_A = 0.3f;
};

/// Replaces `current_A` by `now_A` and returns the change.
inline float replace(float& current_A, float now_A) {
  const float change_A = now_A - current_A;
  current_A = now_A;
  return change_A;
}

/// Whether one of the three changes in a control period may be a jump. In this case is_jump() must check each change.
inline bool is_large(float first_A, float second_A, float third_A) {
  return first_A * first_A + second_A * second_A + third_A * third_A >
         CurrentJump::bearable_A * CurrentJump::bearable_A;
}

/// Whether neither the loop nor the speed explains a change. A loop changes its current by about `error_A`, its
/// previous error. A back EMF changes a current by at most its steady-state current through the resistance.
inline bool is_jump(float change_A, float error_A, float back_emf_V, const Resistance& resistance) {
  const float beyond_A = std::fabs(change_A) - CurrentJump::bearable_A - std::fabs(error_A);
  return beyond_A * resistance.value_ohm > std::fabs(back_emf_V);
}

}  // namespace inkwell::control
