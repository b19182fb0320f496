#include "boards/virtual/plant/arm_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace inkwell::virtual_board {

using protocol::Parameter;

ArmMotion::ArmMotion(const arms::Description& arm, const Vector3& joints_rad)
    : dynamics_(arm),
      stop_stiffness_Nm_per_rad_(arm.simulation.stop_stiffness_Nm_per_rad),
      stop_damping_Nms_per_rad_(arm.simulation.stop_damping_Nms_per_rad),
      coulomb_Nm_(arm.simulation.coulomb_friction_Nm.data()),
      viscous_Nms_per_rad_(arm.simulation.viscous_friction_Nms_per_rad.data()),
      joints_rad_(joints_rad) {
  const auto& p = arm.parameters;
  stops_ = {{{p[Parameter::joint_1_minimum_rad], p[Parameter::joint_1_maximum_rad]},
             {p[Parameter::joint_2_minimum_rad], p[Parameter::joint_2_maximum_rad]},
             {p[Parameter::elbow_minimum_rad], p[Parameter::elbow_maximum_rad]}}};
}

void ArmMotion::place(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s) {
  joints_rad_ = joints_rad;
  speeds_rad_s_ = joint_speeds_rad_s;
  speed_change_rad_s_.setZero();
  friction_impulse_Nms_.setZero();
}

Vector3 ArmMotion::stop_torque_Nm(const Vector3& joints_rad, const Vector3& speeds) const {
  const auto torque = [&](const Stop& stop, double angle_rad, double speed_rad_s) {
    const double beyond_rad = angle_rad - std::clamp(angle_rad, stop.minimum_rad, stop.maximum_rad);
    if (beyond_rad == 0.0) return 0.0;
    const double pushed = -stop_stiffness_Nm_per_rad_ * beyond_rad - stop_damping_Nms_per_rad_ * speed_rad_s;
    return beyond_rad > 0.0 ? std::min(pushed, 0.0) : std::max(pushed, 0.0);  // a stop only pushes
  };
  const bool parallelogram = dynamics_.is_parallelogram();
  const double elbow_speed = parallelogram ? speeds[2] - speeds[1] : speeds[2];
  const double elbow = torque(stops_[2], dynamics_.elbow_rad(joints_rad), elbow_speed);
  return {torque(stops_[0], joints_rad[0], speeds[0]),
          torque(stops_[1], joints_rad[1], speeds[1]) - (parallelogram ? elbow : 0.0), elbow};
}

void ArmMotion::step(double duration_s, const Vector3& torque_Nm, std::span<const Coupling> couplings) {
  const Vector3 middle_rad = joints_rad_ + 0.5 * duration_s * speeds_rad_s_;
  const Vector3 middle_speed = speeds_rad_s_ + 0.5 * speed_change_rad_s_;
  const ArmDynamics::Terms t = dynamics_.terms(middle_rad, middle_speed);

  Vector3 force_N = Vector3::Zero();
  double damping_Ns_per_m = 0.0;
  for (const Coupling& c : couplings) {
    force_N += c.stiffness_N_per_m * (c.target_m - t.position_m) + c.damping_Ns_per_m * c.target_velocity_m_s;
    damping_Ns_per_m += c.damping_Ns_per_m;
  }
  const Vector3 total_Nm = torque_Nm - t.coriolis_Nm - t.gravity_Nm + stop_torque_Nm(middle_rad, middle_speed) +
                           t.jacobian_m.transpose() * force_N;

  Matrix3 damped = t.mass_matrix + (duration_s * damping_Ns_per_m) * (t.jacobian_m.transpose() * t.jacobian_m);
  damped.diagonal() += duration_s * viscous_Nms_per_rad_;
  const Matrix3 inverse = damped.inverse();
  const Vector3 free = inverse * (t.mass_matrix * speeds_rad_s_ + duration_s * total_Nm);

  const Vector3 next = slide(inverse, free, duration_s);
  speed_change_rad_s_ = next - speeds_rad_s_;
  speeds_rad_s_ = next;
  joints_rad_ = middle_rad + 0.5 * duration_s * next;
}

// Solves the friction with projected Gauss-Seidel rounds over the joints. The friction impulse stops a joint within the
// limit of the friction cone. The impulses of the previous step are the initial guess, so one or two rounds are usually
// sufficient.
Vector3 ArmMotion::slide(const Matrix3& inverse_mass, const Vector3& free, double duration_s) {
  constexpr int rounds_maximum = 40;
  constexpr double still_rad_s = 1e-13;
  Vector3 speeds = free + inverse_mass * friction_impulse_Nms_;
  for (int round = 0; round < rounds_maximum; ++round) {
    double largest_change = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double cone = coulomb_Nm_[i] * duration_s;
      const double wanted = friction_impulse_Nms_[i] - speeds[i] / inverse_mass(i, i);
      const double change = std::clamp(wanted, -cone, cone) - friction_impulse_Nms_[i];
      friction_impulse_Nms_[i] += change;
      speeds += inverse_mass.col(i) * change;
      largest_change = std::max(largest_change, std::abs(change * inverse_mass(i, i)));
    }
    if (largest_change < still_rad_s) break;
  }
  return speeds;
}

}  // namespace inkwell::virtual_board
