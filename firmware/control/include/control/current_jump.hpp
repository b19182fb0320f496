// Whether a motor's current changed as a winding lets it.
//
// An inductance does not let its current change at once. A motor or a leg of its bridge that comes open ends it within
// a control period all the same, and a sensor that fails shows another one in no time. What the motors' equation would
// need milliseconds to miss (MotorWatch) is seen in a single reading.
#pragma once

#include <cmath>

#include <control/motor_watch.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

struct CurrentJump {
  /// In a control period, beside what has a reason. Sound motors came to half of that in simulation, where a program
  /// turned a force of 7 N round each millisecond.
  static constexpr float bearable_A = 0.3f;
};

/// Puts `now_A` in the place of `current_A`, and returns by how much it changes.
inline float replace(float& current_A, float now_A) {
  const float change_A = now_A - current_A;
  current_A = now_A;
  return change_A;
}

/// Whether one of the three motors' changes in a control period may be a jump: they deserve a closer look.
inline bool is_large(float first_A, float second_A, float third_A) {
  return first_A * first_A + second_A * second_A + third_A * third_A >
         CurrentJump::bearable_A * CurrentJump::bearable_A;
}

/// Whether neither the loop nor the speed explains a change: a loop moves its current by about what it was short of,
/// `error_A`, and a back EMF drives no more through a resistance than it would in the end.
inline bool is_jump(float change_A, float error_A, float back_emf_V, const Resistance& resistance) {
  const float beyond_A = std::fabs(change_A) - CurrentJump::bearable_A - std::fabs(error_A);
  return beyond_A * resistance.value_ohm > std::fabs(back_emf_V);
}

}  // namespace inkwell::control
