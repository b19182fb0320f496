#include "host/bindings/dropins/arm_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace inkwell::dropins {
namespace {

constexpr int reach_steps = 12;  ///< per joint, from stop to stop

double parameter(inkwell_arm* arm, const std::string& name) {
  double value = 0;
  require(inkwell_get_parameter(arm, name.c_str(), &value));
  return value;
}

/// Reads three parameters, one for each joint or motor.
Vector of_each(inkwell_arm* arm, const std::string& before, const std::string& after) {
  return {parameter(arm, before + "1" + after), parameter(arm, before + "2" + after),
          parameter(arm, before + "3" + after)};
}

Workspace read_box(inkwell_arm* arm) {
  Workspace box;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis{"xyz"[i]};
    box.minimum_m[i] = parameter(arm, "box_minimum_" + axis + "_m");
    box.maximum_m[i] = parameter(arm, "box_maximum_" + axis + "_m");
  }
  return box;
}

Workspace read_reach(inkwell_arm* arm) {
  const double elbow_minimum = parameter(arm, "elbow_minimum_rad"), elbow_maximum = parameter(arm, "elbow_maximum_rad");
  const bool third_is_absolute = parameter(arm, "transmission") == 1.0;
  const Vector lower{parameter(arm, "joint_1_minimum_rad"), parameter(arm, "joint_2_minimum_rad"), elbow_minimum};
  const Vector upper{parameter(arm, "joint_1_maximum_rad"), parameter(arm, "joint_2_maximum_rad"), elbow_maximum};
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Workspace reach{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (int step = 0; step < (reach_steps + 1) * (reach_steps + 1) * (reach_steps + 1); ++step) {
    double joint_rad[3];
    int rest = step;
    for (std::size_t i = 0; i < 3; ++i) {
      joint_rad[i] = lower[i] + (upper[i] - lower[i]) * (rest % (reach_steps + 1)) / reach_steps;
      rest /= reach_steps + 1;
    }
    if (third_is_absolute) joint_rad[2] += joint_rad[1];
    double position_m[3];
    require(inkwell_forward_kinematics(arm, joint_rad, position_m, nullptr));
    for (std::size_t i = 0; i < 3; ++i) {
      reach.minimum_m[i] = std::min(reach.minimum_m[i], position_m[i]);
      reach.maximum_m[i] = std::max(reach.maximum_m[i], position_m[i]);
    }
  }
  return reach;
}

double determinant(const std::array<double, 9>& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

}  // namespace

void require(inkwell_result result) {
  if (result != INKWELL_OK) throw std::runtime_error(inkwell_error_text());
}

ArmFacts read_facts(inkwell_arm* arm) {
  ArmFacts facts{};
  facts.force_maximum_N = parameter(arm, "force_limit_N");
  facts.box = read_box(arm);
  facts.reach = read_reach(arm);
  const Vector ratio = of_each(arm, "gear_ratio_", ""), constant = of_each(arm, "torque_constant_", "_Nm_per_A");
  const Vector limit_A = of_each(arm, "current_limit_", "_A"), continuous_A = of_each(arm, "continuous_current_", "_A");
  const Vector counts = of_each(arm, "encoder_", "_counts_per_turn"), reversed = of_each(arm, "encoder_", "_reversed");
  facts.third_is_absolute = parameter(arm, "transmission") == 1.0;
  const double stretched_m = parameter(arm, "link_2_m") + parameter(arm, "link_3_m");
  facts.force_continuous_N = facts.force_maximum_N;
  for (std::size_t i = 0; i < 3; ++i) {
    facts.joint_torque_full_Nm[i] = constant[i] * ratio[i] * limit_A[i];
    facts.encoder_counts_per_rad[i] =
        (reversed[i] == 1.0 ? -1.0 : 1.0) * counts[i] * ratio[i] / (2.0 * std::numbers::pi);
    facts.force_continuous_N =
        std::min(facts.force_continuous_N, constant[i] * ratio[i] * continuous_A[i] / stretched_m);
  }
  return facts;
}

std::array<double, 9> jacobian_at(inkwell_arm* arm, const double (&joint_rad)[3]) {
  std::array<double, 9> jacobian{};
  double position_m[3];
  if (inkwell_forward_kinematics(arm, joint_rad, position_m, jacobian.data()) != INKWELL_OK) jacobian = {};
  return jacobian;
}

Vector force_of_torques(inkwell_arm* arm, const inkwell_pose& pose, const Vector& torque_Nm) {
  const auto jacobian = jacobian_at(arm, pose.joint_rad);
  const double all = determinant(jacobian);
  // Near a singularity the determinant approaches 0, and the computed forces become unbounded.
  constexpr double smallest_m3 = 1e-6;
  if (std::abs(all) < smallest_m3) return {};
  // Solves J^T F = tau with Cramer's rule.
  Vector force_N{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto replaced = jacobian;
    for (std::size_t joint = 0; joint < 3; ++joint) replaced[3 * axis + joint] = torque_Nm[joint];
    force_N[axis] = determinant(replaced) / all;
  }
  return force_N;
}

}  // namespace inkwell::dropins
