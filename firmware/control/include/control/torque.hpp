// From joint torques to current references (paper, section 3.5).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <control/trigonometry.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

struct Motors {
  Triple ampere_per_Nm;    ///< 1 / (gear ratio * torque constant), negative for a reversed motor
  Triple current_limit_A;  ///< bound of each reference; a motor with 0 takes no part
  Triple ampere_per_heat;  ///< how much the limit falls for each 1 of MotorHeat::beyond
  /// Current that makes a newton at the end of the longer link.
  Triple ampere_per_N;
  std::uint32_t idle = 0;  ///< 1 or 2: of the motors that move the links this one alone takes no part

  float allowed_A(std::size_t motor, const Triple& heat_beyond) const {
    return std::max(0.0f, current_limit_A[motor] - ampere_per_heat[motor] * heat_beyond[motor]);
  }
};

struct CurrentReferences {
  Triple reference_A{};
  bool held_by_current = false;  ///< less than was asked for, by a motor's own limit
  bool held_by_heat = false;     ///< or by that of a hot one
};

/// What a motor may carry, of what is asked of it.
[[gnu::cold, gnu::noinline]] inline float part_of(float allowed_A, float asked_A) {
  return allowed_A * reciprocal_square_root(asked_A * asked_A);
}

/// Currents that give the joint torques. Where one would be above what its motor may carry (`heat_beyond` makes that
/// less) all give way together, so that the force becomes smaller but keeps its direction.
inline CurrentReferences current_references(const Triple& torque_Nm, const Motors& motors, const Triple& heat_beyond) {
  CurrentReferences references;
  float part = 1.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    const float asked_A = torque_Nm[i] * motors.ampere_per_Nm[i];
    references.reference_A[i] = asked_A;
    const float allowed_A = motors.allowed_A(i, heat_beyond);
    if (std::fabs(asked_A) <= allowed_A) continue;
    if (motors.current_limit_A[i] == 0.0f) {
      references.reference_A[i] = 0.0f;
      continue;
    }
    (allowed_A < motors.current_limit_A[i] ? references.held_by_heat : references.held_by_current) = true;
    part = std::min(part, part_of(allowed_A, asked_A));
  }
  for (float& reference_A : references.reference_A) reference_A *= part;
  return references;
}

}  // namespace inkwell::control
