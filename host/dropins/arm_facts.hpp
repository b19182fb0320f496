// What the parameters of an arm mean in HDAPI's terms. Read once, when the arm is opened.
#pragma once

#include <array>
#include <string>

#include <inkwell/inkwell.h>

#include "force_guard.hpp"

namespace inkwell::dropins {

struct Workspace {
  Vector minimum_m, maximum_m;
};

struct ArmFacts {
  double force_maximum_N;
  double force_continuous_N;      ///< that every motor bears for ever, even with the arm stretched out
  Vector joint_torque_full_Nm;    ///< at the current limits
  bool third_is_absolute;         ///< joint 3 is measured from the base, not from link 2
  Vector encoder_counts_per_rad;  ///< negative where an encoder is reversed
  Workspace reach;                ///< of the probe, over all that the joints' stops allow
  Workspace box;                  ///< inside of which the arm is to be used
};

/// Throws std::runtime_error with the library's sentence if it could not do what it was asked.
void require(inkwell_result result);

/// Throws std::runtime_error with the reason if the arm does not answer.
ArmFacts read_facts(inkwell_arm* arm);

/// The force at the probe that gives these joint torques (tau = J^T F); nothing where the arm is stretched out.
Vector force_of_torques(inkwell_arm* arm, const inkwell_pose& pose, const Vector& torque_Nm);

/// Row by row, m/rad: the probe's velocity is this times the joints' speeds.
std::array<double, 9> jacobian_at(inkwell_arm* arm, const double (&joint_rad)[3]);

}  // namespace inkwell::dropins
