// Forward kinematics, Jacobian and virtual work of a three-joint arm (paper, Eq. 1 to 6 and 10 to 15).
//
// Joint 1 of every supported arm rotates a vertical plane with two links. The angles phi2 and phi3 are the link
// directions in this plane. The probe has the following reach r and height h relative to the shoulder:
//
//   r = l2 cos(phi2) + l3 cos(phi3) and  h = l2 sin(phi2) + l3 sin(phi3).
//
// The probe position is origin + r (cos(q1) forward + sin(q1) side) + h up. The transmission defines the zero direction
// of joint 3 (link 2 or the base). The frame defines the workspace axes of forward, side and up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// Transmission from motor 3 to link 3. The values are those of the parameter `transmission`.
enum class Transmission : std::uint8_t {
  serial = 0,         ///< phi3 = q2 + q3 + offset: joint 3 is relative to link 2 (paper)
  parallelogram = 1,  ///< phi3 = q3 + offset: the motor is grounded and joint 3 is absolute (PHANTOM Omni)
};

/// Workspace axes. The values are those of the parameter `frame`.
enum class Frame : std::uint8_t {
  paper = 0,  ///< forward x, side y, up z
  omni = 1,   ///< forward z (to the user), side -x, up y
};

struct Arm {
  Transmission transmission;
  Frame frame;
  float link_2_m;
  float link_3_m;
  float elbow_offset_rad;
  Vector3 origin_m;  ///< shoulder in the workspace
};

/// Column i is the derivative of the probe position with respect to joint angle i, in m/rad.
struct Jacobian {
  std::array<Vector3, 3> column;
};

struct Pose {
  Vector3 position_m;  ///< of the probe, workspace axes
  Jacobian jacobian;
};

/// Link ends in workspace axes: p1, p2 and p_end of the paper's section 3.4.
struct LinkEnds {
  Vector3 shoulder_m;
  Vector3 elbow_m;
  Vector3 probe_m;
};

/// Returns probe position and Jacobian. The joint angles must not exceed a few turns.
Pose forward_kinematics(const Triple& joint_rad, const Arm& arm);

LinkEnds link_ends(const Triple& joint_rad, const Arm& arm);

/// Probe velocity: J times the joint speeds.
Vector3 probe_velocity(const Jacobian& jacobian, const Triple& joint_speed_rad_per_s);

/// Returns the joint torques tau = J^T F for `force_N` on the hand.
Triple joint_torques(const Jacobian& jacobian, const Vector3& force_N);

/// Sets the torque of an idle link joint to zero and corrects the torque of the other link joint. `idle` is 1 for joint
/// 2 and 2 for joint 3. The resulting force is never larger than the requested force. The torque of joint 1 does not
/// change.
[[gnu::cold]] void remove_idle_torque(std::size_t idle, Triple& torque_Nm, const Jacobian& jacobian);

/// Elbow angle: the angle of link 3 relative to link 2. The elbow stops limit the elbow angle. On a parallelogram the
/// elbow angle is joint 3 minus joint 2.
float elbow_rad(const Triple& joint_rad, Transmission transmission);

}  // namespace inkwell::control
