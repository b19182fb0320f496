// How the stylus stands in the workspace.
#pragma once

#include <array>

#include <glm/mat3x3.hpp>

#include <control/kinematics.hpp>

namespace inkwell::kinematics {

/// The side of the plane that the links lie in: a unit vector, to the right of an arm that faces the user.
glm::vec3 arm_side(float waist_rad, control::Frame frame);

/// Rotation of the stylus: columns are its axes in the workspace. x points to its side, z along it, from its tip to its
/// back. `gimbal_rad`: yaw about the forearm, pitch about the axis across it, roll about the stylus itself. With all
/// three at zero the stylus stands square on the forearm, in the arm's plane, away from the base. Signs as OpenHaptics
/// has them: right, down and clockwise are where the stylus goes for a negative, positive and positive angle.
glm::mat3 stylus_rotation(const std::array<float, 3>& joint_rad, const std::array<float, 3>& gimbal_rad,
                          const control::Arm& arm);

}  // namespace inkwell::kinematics
