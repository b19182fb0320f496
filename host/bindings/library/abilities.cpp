#include "host/bindings/library/abilities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/reports.hpp"

namespace inkwell::library {
namespace {

using protocol::Parameter;

/// Published stiffness and damping of the Omni. Programs scale their forces with these values.
constexpr double loop_stiffness_N_per_m = 500, loop_damping_Ns_per_m = 2;

constexpr int reach_steps = 12;  ///< per joint, from stop to stop

void copy(const std::array<float, 3>& from, double (&to)[3]) { std::copy(from.begin(), from.end(), to); }

void add_reach(inkwell_abilities& abilities, const control::Arm& geometry) {
  std::fill_n(abilities.reach_minimum_m, 3, std::numeric_limits<double>::infinity());
  std::fill_n(abilities.reach_maximum_m, 3, -std::numeric_limits<double>::infinity());
  constexpr int positions = reach_steps + 1;
  for (int step = 0; step < positions * positions * positions; ++step) {
    control::Triple joint_rad{};
    int rest = step;
    for (std::size_t i = 0; i < 3; ++i) {
      const double range_rad = abilities.joint_maximum_rad[i] - abilities.joint_minimum_rad[i];
      joint_rad[i] = static_cast<float>(abilities.joint_minimum_rad[i] + range_rad * (rest % positions) / reach_steps);
      rest /= positions;
    }
    if (abilities.third_joint_is_absolute != 0) joint_rad[2] += joint_rad[1];
    const control::Vector3 probe_m = control::forward_kinematics(joint_rad, geometry).position_m;
    const double position_m[3]{probe_m.x, probe_m.y, probe_m.z};
    for (std::size_t i = 0; i < 3; ++i) {
      abilities.reach_minimum_m[i] = std::min(abilities.reach_minimum_m[i], position_m[i]);
      abilities.reach_maximum_m[i] = std::max(abilities.reach_maximum_m[i], position_m[i]);
    }
  }
}

}  // namespace

inkwell_abilities abilities_of(const protocol::ParameterSet& parameters, const control::Arm& geometry) {
  inkwell_abilities abilities{};
  copy(parameters.of_each(Parameter::box_minimum_x_m), abilities.workspace_minimum_m);
  copy(parameters.of_each(Parameter::box_maximum_x_m), abilities.workspace_maximum_m);
  abilities.workspace_radius_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i)
    abilities.workspace_radius_m = std::min(
        abilities.workspace_radius_m, 0.5 * (abilities.workspace_maximum_m[i] - abilities.workspace_minimum_m[i]));
  copy(parameters.of_each(protocol::lower_stops), abilities.joint_minimum_rad);
  copy(parameters.of_each(protocol::upper_stops), abilities.joint_maximum_rad);
  abilities.third_joint_is_absolute = geometry.transmission == control::Transmission::parallelogram ? 1 : 0;
  add_reach(abilities, geometry);

  const auto ratio = parameters.of_each(Parameter::gear_ratio_1);
  const auto constant_Nm_per_A = parameters.of_each(Parameter::torque_constant_1_Nm_per_A);
  const auto limit_A = parameters.of_each(Parameter::current_limit_1_A);
  const auto continuous_A = parameters.of_each(Parameter::continuous_current_1_A);
  abilities.force_N = parameters[Parameter::force_limit_N];
  abilities.continuous_force_N = abilities.force_N;
  const double stretched_m = static_cast<double>(geometry.link_2_m) + static_cast<double>(geometry.link_3_m);
  for (std::size_t i = 0; i < 3; ++i) {
    const double joint_Nm_per_A = static_cast<double>(constant_Nm_per_A[i]) * static_cast<double>(ratio[i]);
    abilities.joint_torque_Nm[i] = joint_Nm_per_A * static_cast<double>(limit_A[i]);
    abilities.continuous_joint_torque_Nm[i] =
        joint_Nm_per_A * static_cast<double>(std::min(limit_A[i], continuous_A[i]));
    abilities.continuous_force_N =
        std::min(abilities.continuous_force_N, joint_Nm_per_A * static_cast<double>(continuous_A[i]) / stretched_m);
  }
  abilities.stiffness_N_per_m = loop_stiffness_N_per_m;
  abilities.damping_Ns_per_m = loop_damping_Ns_per_m;
  abilities.pose_rate_Hz = protocol::pose_rate_Hz;
  return abilities;
}

std::optional<std::array<double, 3>> force_of_torques(const control::Jacobian& jacobian, const double (&torque_Nm)[3]) {
  using Column = std::array<double, 3>;
  std::array<Column, 3> columns{};
  for (std::size_t i = 0; i < 3; ++i) columns[i] = {jacobian.column[i].x, jacobian.column[i].y, jacobian.column[i].z};
  const auto cross = [](const Column& a, const Column& b) {
    return Column{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<Column, 3> crosses{cross(columns[1], columns[2]), cross(columns[2], columns[0]),
                                      cross(columns[0], columns[1])};
  double determinant_m3 = 0;
  for (std::size_t i = 0; i < 3; ++i) determinant_m3 += columns[0][i] * crosses[0][i];
  // Near a singularity the determinant approaches 0, and the computed forces become unbounded.
  constexpr double smallest_m3 = 1e-6;
  if (std::abs(determinant_m3) < smallest_m3) return std::nullopt;
  Column force_N{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) force_N[axis] += torque_Nm[i] * crosses[i][axis] / determinant_m3;
  return force_N;
}

}  // namespace inkwell::library
