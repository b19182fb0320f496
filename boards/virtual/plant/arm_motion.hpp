// Time integration of the arm: motor torques, couplings at the probe, static friction and joint stops.
#pragma once

#include <array>
#include <span>

#include "boards/virtual/plant/arm_dynamics.hpp"
#include "boards/virtual/plant/hand.hpp"

namespace inkwell::virtual_board {

class ArmMotion {
 public:
  ArmMotion(const arms::Description& arm, const Vector3& joints_rad);

  /// Advances by one step with the motor torques at the joints and the couplings at the probe. The integrator is
  /// position Verlet. Position Verlet evaluates forces in the middle of the step to avoid energy drift. Damping is
  /// implicit. The Coulomb friction impulse stops a joint within the limit of the friction cone (Moreau's time
  /// stepping). Therefore a resting arm does not creep.
  void step(double duration_s, const Vector3& torque_Nm, std::span<const Coupling> couplings);

  const Vector3& joints_rad() const { return joints_rad_; }
  const Vector3& joint_speeds_rad_s() const { return speeds_rad_s_; }
  void place(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s);
  const ArmDynamics& dynamics() const { return dynamics_; }
  /// Torques of the stops at these joint angles and speeds.
  Vector3 stop_torque_Nm(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s) const;

 private:
  struct Stop {
    double minimum_rad, maximum_rad;
  };
  Vector3 slide(const Matrix3& inverse_mass, const Vector3& free_speeds_rad_s, double duration_s);

  ArmDynamics dynamics_;
  std::array<Stop, 3> stops_;  ///< joint 1, joint 2, elbow
  double stop_stiffness_Nm_per_rad_, stop_damping_Nms_per_rad_;
  Vector3 coulomb_Nm_, viscous_Nms_per_rad_;

  Vector3 joints_rad_;
  Vector3 speeds_rad_s_ = Vector3::Zero();
  Vector3 speed_change_rad_s_ = Vector3::Zero();    ///< of the last step, to predict the middle of the next
  Vector3 friction_impulse_Nms_ = Vector3::Zero();  ///< of the last step, initial guess of the next
};

}  // namespace inkwell::virtual_board
