#include "boards/virtual/plant/arm_dynamics.hpp"

#include <cmath>

namespace inkwell::virtual_board {

using protocol::Parameter;

ArmDynamics::ArmDynamics(const arms::Description& arm) {
  const auto& p = arm.parameters;
  const auto& s = arm.simulation;
  parallelogram_ = p[Parameter::transmission] == 1.0f;
  omni_frame_ = p[Parameter::frame] == 1.0f;
  link_2_m_ = p[Parameter::link_2_m];
  link_3_m_ = p[Parameter::link_3_m];
  elbow_offset_rad_ = p[Parameter::elbow_offset_rad];
  origin_m_ = {p[Parameter::origin_x_m], p[Parameter::origin_y_m], p[Parameter::origin_z_m]};

  const double beyond_elbow_kg = s.link_3_mass_kg + s.probe_mass_kg;
  const double moment_2 = s.link_2_mass_kg * s.link_2_centre_m + beyond_elbow_kg * link_2_m_;  // S2
  const double moment_3 = s.link_3_mass_kg * s.link_3_centre_m + s.probe_mass_kg * link_3_m_;  // S3
  turret_kg_m2_ = s.base_inertia_kg_m2;
  link_2_kg_m2_ = s.link_2_inertia_kg_m2 + s.link_2_mass_kg * s.link_2_centre_m * s.link_2_centre_m +
                  beyond_elbow_kg * link_2_m_ * link_2_m_;
  link_3_kg_m2_ = s.link_3_inertia_kg_m2 + s.link_3_mass_kg * s.link_3_centre_m * s.link_3_centre_m +
                  s.probe_mass_kg * link_3_m_ * link_3_m_;
  coupling_kg_m2_ = moment_3 * link_2_m_;
  weight_2_Nm_ = s.gravity_m_per_s2 * moment_2;
  weight_3_Nm_ = s.gravity_m_per_s2 * moment_3;

  const Vector3 ratio(p[Parameter::gear_ratio_1], p[Parameter::gear_ratio_2], p[Parameter::gear_ratio_3]);
  rotors_kg_m2_ = s.rotor_inertia_kg_m2 * ratio.cwiseAbs2();
}

ArmDynamics::Links ArmDynamics::links(const Vector3& q) const {
  const double a = q[1];
  const double b = (parallelogram_ ? q[2] : q[1] + q[2]) + elbow_offset_rad_;
  return {std::cos(q[0]), std::sin(q[0]), std::cos(a), std::sin(a), std::cos(b), std::sin(b)};
}

Vector3 ArmDynamics::workspace_m(const Links& l) const {
  const double reach = link_2_m_ * l.cos_a + link_3_m_ * l.cos_b;
  const double height = link_2_m_ * l.sin_a + link_3_m_ * l.sin_b;
  if (omni_frame_) return origin_m_ + Vector3(-reach * l.sin_1, height, reach * l.cos_1);
  return origin_m_ + Vector3(reach * l.cos_1, reach * l.sin_1, height);
}

Vector3 ArmDynamics::position_m(const Vector3& joints_rad) const { return workspace_m(links(joints_rad)); }

Matrix3 ArmDynamics::jacobian_m(const Links& l) const {
  const double reach = link_2_m_ * l.cos_a + link_3_m_ * l.cos_b;
  const auto turn = [&](double along, double up) {  // from the arm's plane to the workspace
    return omni_frame_ ? Vector3(-along * l.sin_1, up, along * l.cos_1) : Vector3(along * l.cos_1, along * l.sin_1, up);
  };
  const Vector3 by_1 =
      omni_frame_ ? Vector3(-reach * l.cos_1, 0.0, -reach * l.sin_1) : Vector3(-reach * l.sin_1, reach * l.cos_1, 0.0);
  const Vector3 by_a = turn(-link_2_m_ * l.sin_a, link_2_m_ * l.cos_a);
  const Vector3 by_b = turn(-link_3_m_ * l.sin_b, link_3_m_ * l.cos_b);
  Matrix3 jacobian_m;
  if (parallelogram_)
    jacobian_m << by_1, by_a, by_b;
  else
    jacobian_m << by_1, by_a + by_b, by_b;  // b = q2 + q3
  return jacobian_m;
}

ArmDynamics::Terms ArmDynamics::terms(const Vector3& q, const Vector3& speed) const {
  const Links l = links(q);
  const double w = speed[0];
  const double a_speed = speed[1];
  const double b_speed = parallelogram_ ? speed[2] : speed[1] + speed[2];

  // Link coordinates. The Coriolis terms follow from Lagrange's equations for the energies in arm_dynamics.hpp.
  const double cos_difference = l.cos_a * l.cos_b + l.sin_a * l.sin_b;
  const double sin_difference = l.sin_a * l.cos_b - l.cos_a * l.sin_b;
  const double waist = turret_kg_m2_ + link_2_kg_m2_ * l.cos_a * l.cos_a + link_3_kg_m2_ * l.cos_b * l.cos_b +
                       2.0 * coupling_kg_m2_ * l.cos_a * l.cos_b;
  const double waist_by_a = -2.0 * l.sin_a * (link_2_kg_m2_ * l.cos_a + coupling_kg_m2_ * l.cos_b);
  const double waist_by_b = -2.0 * l.sin_b * (link_3_kg_m2_ * l.cos_b + coupling_kg_m2_ * l.cos_a);
  const double elbow = coupling_kg_m2_ * cos_difference;
  const double elbow_by_a = coupling_kg_m2_ * sin_difference;
  const double coriolis_1 = (waist_by_a * a_speed + waist_by_b * b_speed) * w;
  const double coriolis_a = elbow_by_a * b_speed * b_speed - 0.5 * waist_by_a * w * w;
  const double coriolis_b = -elbow_by_a * a_speed * a_speed - 0.5 * waist_by_b * w * w;
  const double gravity_a = weight_2_Nm_ * l.cos_a;
  const double gravity_b = weight_3_Nm_ * l.cos_b;

  Terms t;
  t.position_m = workspace_m(l);
  t.jacobian_m = jacobian_m(l);
  if (parallelogram_) {  // u = q
    t.mass_matrix << waist, 0, 0, 0, link_2_kg_m2_, elbow, 0, elbow, link_3_kg_m2_;
    t.coriolis_Nm = {coriolis_1, coriolis_a, coriolis_b};
    t.gravity_Nm = {0.0, gravity_a, gravity_b};
  } else {  // b = q2 + q3, so each torque on b acts on q2 and on q3
    const double both = link_2_kg_m2_ + link_3_kg_m2_ + 2.0 * elbow;
    const double half = link_3_kg_m2_ + elbow;
    t.mass_matrix << waist, 0, 0, 0, both, half, 0, half, link_3_kg_m2_;
    t.coriolis_Nm = {coriolis_1, coriolis_a + coriolis_b, coriolis_b};
    t.gravity_Nm = {0.0, gravity_a + gravity_b, gravity_b};
  }
  t.mass_matrix.diagonal() += rotors_kg_m2_;
  return t;
}

double ArmDynamics::kinetic_energy_J(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s) const {
  return 0.5 * joint_speeds_rad_s.dot(terms(joints_rad, joint_speeds_rad_s).mass_matrix * joint_speeds_rad_s);
}

double ArmDynamics::potential_energy_J(const Vector3& joints_rad) const {
  const Links l = links(joints_rad);
  return weight_2_Nm_ * l.sin_a + weight_3_Nm_ * l.sin_b;
}

}  // namespace inkwell::virtual_board
