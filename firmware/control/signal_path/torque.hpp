// Conversion of joint torques to current references (paper, section 3.5).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/trigonometry.hpp"
#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

struct Motors {
  Triple ampere_per_Nm;    ///< 1 / (gear ratio * torque constant), negative for a reversed motor
  Triple current_limit_A;  ///< bound of each reference; a motor with limit 0 is not used
  Triple ampere_per_heat;  ///< reduction of the current limit per unit of MotorHeat::beyond
  /// Current for 1 N at the end of the longer link.
  Triple ampere_per_N;
  std::uint32_t idle = 0;  ///< index (1 or 2) of the only link motor that is not used, otherwise 0

  float allowed_A(std::size_t motor, const Triple& heat_beyond) const {
    return std::max(0.0f, current_limit_A[motor] - ampere_per_heat[motor] * heat_beyond[motor]);
  }
};

struct CurrentReferences {
  Triple reference_A{};
  bool held_by_current = false;  ///< reduced by a current limit
  bool held_by_heat = false;     ///< reduced by the lower current limit of a hot motor
};

/// Returns the allowed fraction of the requested current.
[[gnu::cold, gnu::noinline]] inline float part_of(float allowed_A, float requested_A) {
  return allowed_A * reciprocal_square_root(requested_A * requested_A);
}

/// Returns the currents for the joint torques. If one motor would exceed its limit, all currents are scaled down by the
/// same factor. The allowed current falls with `heat_beyond`.
inline CurrentReferences current_references(const Triple& torque_Nm, const Motors& motors, const Triple& heat_beyond) {
  CurrentReferences references;
  float part = 1.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    const float requested_A = torque_Nm[i] * motors.ampere_per_Nm[i];
    references.reference_A[i] = requested_A;
    const float allowed_A = motors.allowed_A(i, heat_beyond);
    if (std::fabs(requested_A) <= allowed_A) continue;
    if (motors.current_limit_A[i] == 0.0f) {
      references.reference_A[i] = 0.0f;
      continue;
    }
    (allowed_A < motors.current_limit_A[i] ? references.held_by_heat : references.held_by_current) = true;
    part = std::min(part, part_of(allowed_A, requested_A));
  }
  for (float& reference_A : references.reference_A) reference_A *= part;
  return references;
}

}  // namespace inkwell::control
