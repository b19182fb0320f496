// Properties of an arm in HDAPI terms, read once when the arm is opened.
#pragma once

#include <array>
#include <string>

#include <inkwell/inkwell.h>

#include "host/bindings/dropins/force_guard.hpp"

namespace inkwell::dropins {

struct Workspace {
  Vector minimum_m, maximum_m;
};

struct ArmFacts {
  double force_maximum_N;
  double force_continuous_N;      ///< tolerated continuously by every motor, even with the arm stretched out
  Vector joint_torque_full_Nm;    ///< at the motor current limits
  bool third_is_absolute;         ///< joint 3 is measured from the base, not from link 2
  Vector encoder_counts_per_rad;  ///< negative where an encoder is reversed
  Workspace reach;                ///< range of the probe within the joint stops
  Workspace box;                  ///< usable range
};

/// Throws std::runtime_error with the library's error text if the result is an error.
void require(inkwell_result result);

/// Throws std::runtime_error with the reason if the arm does not answer.
ArmFacts read_facts(inkwell_arm* arm);

/// Force at the probe for these joint torques (tau = J^T F); zero where the arm is singular.
Vector force_of_torques(inkwell_arm* arm, const inkwell_pose& pose, const Vector& torque_Nm);

/// Jacobian in row-major order, m/rad. The Jacobian times the joint speeds is the probe velocity.
std::array<double, 9> jacobian_at(inkwell_arm* arm, const double (&joint_rad)[3]);

}  // namespace inkwell::dropins
