// From joint torques to current references (paper, section 3.5).
#pragma once

#include <algorithm>
#include <cmath>

#include <control/trigonometry.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

struct Motors {
  Triple ampere_per_Nm;    ///< 1 / (gear ratio * torque constant), negative for a reversed motor
  Triple current_limit_A;  ///< bound of each reference; a motor with 0 takes no part
};

struct CurrentReferences {
  Triple reference_A{};
  bool limited = false;  ///< less than was asked for
};

/// Currents that give the joint torques; `held_back_A` makes a limit lower. Where one would be above its limit all give
/// way together, so that the force becomes smaller but keeps its direction.
inline CurrentReferences current_references(const Triple& torque_Nm, const Motors& motors, const Triple& held_back_A) {
  CurrentReferences references;
  float part = 1.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    const float asked_A = torque_Nm[i] * motors.ampere_per_Nm[i];
    const float limit_A = motors.current_limit_A[i] - held_back_A[i];
    references.reference_A[i] = asked_A;
    if (std::fabs(asked_A) <= limit_A) continue;
    references.limited = true;
    if (motors.current_limit_A[i] == 0.0f)
      references.reference_A[i] = 0.0f;
    else
      part = std::min(part, std::max(0.0f, limit_A) * reciprocal_square_root(asked_A * asked_A));
  }
  if (references.limited)
    for (float& reference_A : references.reference_A) reference_A *= part;
  return references;
}

}  // namespace inkwell::control
