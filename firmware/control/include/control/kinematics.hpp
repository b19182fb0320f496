// Forward kinematics, Jacobian and virtual work of a three-joint arm (paper, Eq. 1 to 6 and 10 to 15).
//
// Every arm of this family is two links in a vertical plane that joint 1 turns. With phi2 and phi3 the
// directions of the links in that plane, reach and height of the probe over the shoulder are
//
//   r = l2 cos(phi2) + l3 cos(phi3)      h = l2 sin(phi2) + l3 sin(phi3)
//
// and the probe is at  origin + r (cos(q1) forward + sin(q1) side) + h up.  What differs is the drive
// (is joint 3 measured from link 2 or from the base?) and which workspace axes forward, side and up are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <control/vector.hpp>

namespace inkwell::control {

/// How motor 3 turns link 3. The values are those of the parameter `transmission`.
enum class Transmission : std::uint8_t {
  serial = 0,         ///< phi3 = q2 + q3 + offset: joint 3 is relative to link 2 (paper)
  parallelogram = 1,  ///< phi3 = q3 + offset: a grounded motor, joint 3 is absolute (PHANTOM Omni)
};

/// Which axes the workspace has. The values are those of the parameter `frame`.
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
  Vector3 origin_m;  ///< the shoulder in the workspace
};

/// Column i is the probe's velocity for a unit speed of joint i, in m/rad, workspace axes.
struct Jacobian {
  std::array<Vector3, 3> column;
};

struct Pose {
  Vector3 position_m;  ///< of the probe, workspace axes
  Jacobian jacobian;
};

/// Ends of the links in workspace axes: p1, p2 and p_end of the paper's section 3.4. Link 1 has no length.
struct LinkEnds {
  Vector3 shoulder_m;
  Vector3 elbow_m;
  Vector3 probe_m;
};

/// Position of the probe and Jacobian for joint angles of a few turns at most.
Pose forward_kinematics(const Triple& joint_rad, const Arm& arm);

/// Where the links begin and end, for drawing.
LinkEnds link_ends(const Triple& joint_rad, const Arm& arm);

/// Velocity of the probe: J times the joints' speeds.
Vector3 probe_velocity(const Jacobian& jacobian, const Triple& joint_speed_rad_per_s);

/// Joint torques that put `force_N` on the hand: tau = J^T F, from tau . dq = F . dx.
Triple joint_torques(const Jacobian& jacobian, const Vector3& force_N);

/// What joint 2 or 3 (`idle` is 1 or 2) does not make of these torques, the other one makes up for as well as it can:
/// the force is the nearest that needs no torque at the idle joint, and never larger. Joint 1 has no part in that,
/// because it moves the probe at right angles to both.
[[gnu::cold]] void leave_out(std::size_t idle, Triple& torque_Nm, const Jacobian& jacobian);

/// Angle between link 3 and link 2 as the stops of the elbow know it: joint 3 less joint 2 on a parallelogram.
float elbow_rad(const Triple& joint_rad, Transmission transmission);

}  // namespace inkwell::control
