// From joint torques to current references (paper, section 3.5).
#pragma once

#include <control/vector.hpp>

namespace inkwell::control {

struct Motors {
  Triple ampere_per_Nm;    ///< 1 / (gear ratio * torque constant), negative for a reversed motor
  Triple current_limit_A;  ///< bound of each reference
};

/// Currents that give the joint torques, each within its limit.
constexpr Triple current_references(const Triple& torque_Nm, const Motors& motors) {
  Triple reference_A{};
  for (std::size_t i = 0; i < 3; ++i)
    reference_A[i] =
        clamp(torque_Nm[i] * motors.ampere_per_Nm[i], -motors.current_limit_A[i], motors.current_limit_A[i]);
  return reference_A;
}

}  // namespace inkwell::control
