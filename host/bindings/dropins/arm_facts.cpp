#include "host/bindings/dropins/arm_facts.hpp"

#include <numbers>
#include <stdexcept>

namespace inkwell::dropins {
namespace {

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

Vector vector(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

}  // namespace

void require(inkwell_result result) {
  if (result != INKWELL_OK) throw std::runtime_error(inkwell_error_text());
}

ArmFacts read_facts(inkwell_arm* arm) {
  inkwell_abilities abilities;
  require(inkwell_get_abilities(arm, &abilities, sizeof abilities));
  ArmFacts facts{};
  facts.force_maximum_N = abilities.force_N;
  facts.force_continuous_N = abilities.continuous_force_N;
  facts.stiffness_N_per_m = abilities.stiffness_N_per_m;
  facts.damping_Ns_per_m = abilities.damping_Ns_per_m;
  facts.joint_torque_full_Nm = vector(abilities.joint_torque_Nm);
  facts.third_is_absolute = abilities.third_joint_is_absolute != 0;
  facts.box = {vector(abilities.workspace_minimum_m), vector(abilities.workspace_maximum_m)};
  facts.reach = {vector(abilities.reach_minimum_m), vector(abilities.reach_maximum_m)};
  const Vector ratio = of_each(arm, "gear_ratio_", "");
  const Vector counts = of_each(arm, "encoder_", "_counts_per_turn"), reversed = of_each(arm, "encoder_", "_reversed");
  for (std::size_t i = 0; i < 3; ++i)
    facts.encoder_counts_per_rad[i] =
        (reversed[i] == 1.0 ? -1.0 : 1.0) * counts[i] * ratio[i] / (2.0 * std::numbers::pi);
  return facts;
}

std::array<double, 9> jacobian_at(inkwell_arm* arm, const double (&joint_rad)[3]) {
  std::array<double, 9> jacobian{};
  double position_m[3];
  if (inkwell_forward_kinematics(arm, joint_rad, position_m, jacobian.data()) != INKWELL_OK) jacobian = {};
  return jacobian;
}

Vector force_of_torques(inkwell_arm* arm, const inkwell_pose& pose, const Vector& torque_Nm) {
  Vector force_N{};
  inkwell_force_of_torques(arm, pose.joint_rad, torque_Nm.data(), force_N.data());  // 0 after an error
  return force_N;
}

}  // namespace inkwell::dropins
