// Rigid-body model of the arm: kinematics and the terms of the equation of motion.
//
// The model uses joint coordinates and link coordinates. The encoders measure the joint coordinates q = (q1, q2, q3).
// On a serial arm q3 is relative to link 2; on a parallelogram q3 is absolute. The link coordinates are u = (q1, a, b).
// The angles of links 2 and 3 above the horizontal are a and b. In link coordinates, serial arms and parallelogram arms
// have the same energies.
//
//   Kinetic energy:    (M11(a, b) q1'^2 + J2 a'^2 + J3 b'^2 + 2 H cos(a - b) a' b') / 2.
//   Waist inertia:     M11(a, b) = I + J2 cos^2 a + J3 cos^2 b + 2 H cos a cos b.
//   Potential energy:  g (S2 sin a + S3 sin b).
//
// J2, J3, H, S2 and S3 combine the masses of the links and the probe. I is the inertia of the turret. The motor rotors
// turn with the joints through the gears. The parallelogram rods are included in links 2 and 3.
#pragma once

#include <Eigen/Core>
#include "boards/arms/description.hpp"

namespace inkwell::virtual_board {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

class ArmDynamics {
 public:
  explicit ArmDynamics(const arms::Description& arm);

  /// Terms of the equation M(q) q'' + coriolis(q, q') + gravity(q) = torque.
  struct Terms {
    Matrix3 mass_matrix;  ///< kg m^2, including the rotors
    Vector3 coriolis_Nm;  ///< centrifugal and Coriolis torques
    Vector3 gravity_Nm;
    Vector3 position_m;  ///< probe position in the workspace
    Matrix3 jacobian_m;  ///< see jacobian_m()
  };
  Terms terms(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s) const;

  Vector3 position_m(const Vector3& joints_rad) const;
  /// d position / d joints
  Matrix3 jacobian_m(const Vector3& joints_rad) const { return jacobian_m(links(joints_rad)); }
  double kinetic_energy_J(const Vector3& joints_rad, const Vector3& joint_speeds_rad_s) const;
  double potential_energy_J(const Vector3& joints_rad) const;
  /// Elbow angle: joint 3 of a serial arm, or joint 3 minus joint 2 of a parallelogram arm.
  double elbow_rad(const Vector3& joints_rad) const {
    return parallelogram_ ? joints_rad[2] - joints_rad[1] : joints_rad[2];
  }
  bool is_parallelogram() const { return parallelogram_; }

 private:
  struct Links {
    double cos_1, sin_1;  ///< waist
    double cos_a, sin_a, cos_b, sin_b;
  };
  Links links(const Vector3& joints_rad) const;
  Vector3 workspace_m(const Links& links) const;
  Matrix3 jacobian_m(const Links& links) const;

  bool parallelogram_;
  bool omni_frame_;
  double link_2_m_, link_3_m_, elbow_offset_rad_;
  Vector3 origin_m_;
  double turret_kg_m2_;                 ///< I
  double link_2_kg_m2_, link_3_kg_m2_;  ///< J2, J3
  double coupling_kg_m2_;               ///< H
  double weight_2_Nm_, weight_3_Nm_;    ///< g S2, g S3
  Vector3 rotors_kg_m2_;                ///< reflected to the joints
};

}  // namespace inkwell::virtual_board
