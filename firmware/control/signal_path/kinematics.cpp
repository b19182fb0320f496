#include "firmware/control/signal_path/kinematics.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

struct LinkDirections {
  SineCosine waist;
  SineCosine link_2;
  SineCosine link_3;
};

LinkDirections link_directions(const Triple& joint_rad, const Arm& arm) {
  const float relative_to_rad = arm.transmission == Transmission::serial ? joint_rad[1] : 0.0f;
  return {sine_cosine(joint_rad[0]), sine_cosine(joint_rad[1]),
          sine_cosine(relative_to_rad + joint_rad[2] + arm.elbow_offset_rad)};
}

/// Converts the forward, side and up components of a direction to workspace axes.
Vector3 in_workspace(Frame frame, float forward, float side, float up) {
  return frame == Frame::paper ? Vector3{forward, side, up} : Vector3{-side, up, forward};
}

/// Converts a point in the arm plane, relative to the shoulder, to workspace axes.
Vector3 from_plane(Frame frame, const SineCosine& waist, float reach_m, float height_m) {
  return in_workspace(frame, reach_m * waist.cosine, reach_m * waist.sine, height_m);
}

}  // namespace

Pose forward_kinematics(const Triple& joint_rad, const Arm& arm) {
  const LinkDirections direction = link_directions(joint_rad, arm);
  const float reach_2_m = arm.link_2_m * direction.link_2.cosine;
  const float height_2_m = arm.link_2_m * direction.link_2.sine;
  const float reach_3_m = arm.link_3_m * direction.link_3.cosine;
  const float height_3_m = arm.link_3_m * direction.link_3.sine;
  const float reach_m = reach_2_m + reach_3_m;
  const SineCosine& waist = direction.waist;

  const Vector3 along_waist = in_workspace(arm.frame, -reach_m * waist.sine, reach_m * waist.cosine, 0.0f);
  // The end of a rotating link moves perpendicular to the link.
  const Vector3 along_link_2 = from_plane(arm.frame, waist, -height_2_m, reach_2_m);
  const Vector3 along_link_3 = from_plane(arm.frame, waist, -height_3_m, reach_3_m);
  const bool link_2_carries_link_3 = arm.transmission == Transmission::serial;

  return {arm.origin_m + from_plane(arm.frame, waist, reach_m, height_2_m + height_3_m),
          {{along_waist, link_2_carries_link_3 ? along_link_2 + along_link_3 : along_link_2, along_link_3}}};
}

LinkEnds link_ends(const Triple& joint_rad, const Arm& arm) {
  const LinkDirections direction = link_directions(joint_rad, arm);
  const Vector3 elbow_m = arm.origin_m + from_plane(arm.frame, direction.waist, arm.link_2_m * direction.link_2.cosine,
                                                    arm.link_2_m * direction.link_2.sine);
  return {arm.origin_m, elbow_m,
          elbow_m + from_plane(arm.frame, direction.waist, arm.link_3_m * direction.link_3.cosine,
                               arm.link_3_m * direction.link_3.sine)};
}

Vector3 probe_velocity(const Jacobian& jacobian, const Triple& joint_speed_rad_per_s) {
  return joint_speed_rad_per_s[0] * jacobian.column[0] + joint_speed_rad_per_s[1] * jacobian.column[1] +
         joint_speed_rad_per_s[2] * jacobian.column[2];
}

Triple joint_torques(const Jacobian& jacobian, const Vector3& force_N) {
  return {dot(jacobian.column[0], force_N), dot(jacobian.column[1], force_N), dot(jacobian.column[2], force_N)};
}

void remove_idle_torque(std::size_t idle, Triple& torque_Nm, const Jacobian& jacobian) {
  constexpr float no_lever_m2_per_rad2 = 1e-12f;  // prevents a division by 0
  const std::size_t other = 3 - idle;
  const Vector3& lever = jacobian.column[idle];
  const float part = dot(lever, jacobian.column[other]) * reciprocal(dot(lever, lever) + no_lever_m2_per_rad2);
  torque_Nm[other] -= part * torque_Nm[idle];
  torque_Nm[idle] = 0.0f;
}

float elbow_rad(const Triple& joint_rad, Transmission transmission) {
  return transmission == Transmission::serial ? joint_rad[2] : joint_rad[2] - joint_rad[1];
}

}  // namespace inkwell::control
