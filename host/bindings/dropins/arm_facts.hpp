// Properties of an arm in HDAPI terms.
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
  double force_continuous_N;  ///< tolerated continuously by every motor, even with the arm stretched out
  double stiffness_N_per_m, damping_Ns_per_m;
  Vector joint_torque_full_Nm;    ///< at the motor current limits
  bool third_is_absolute;         ///< joint 3 is measured from the base, not from link 2
  Vector encoder_counts_per_rad;  ///< negative where an encoder is reversed
  Workspace reach;                ///< range of the probe within the joint stops
  Workspace box;                  ///< usable range
};

/// Throws std::runtime_error with inkwell_error_text() if `result` is not INKWELL_OK.
void require(inkwell_result result);

/// Throws std::runtime_error if the arm does not answer.
ArmFacts read_facts(inkwell_arm* arm);

/// Returns the probe force that the joint torques produce (tau = J^T F). Returns zero at a singularity of the arm.
Vector force_of_torques(inkwell_arm* arm, const inkwell_pose& pose, const Vector& torque_Nm);

/// Jacobian in row-major order, m/rad.
std::array<double, 9> jacobian_at(inkwell_arm* arm, const double (&joint_rad)[3]);

}  // namespace inkwell::dropins
