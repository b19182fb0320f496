// Orientation of the stylus in the workspace.
#pragma once

#include <array>

#include <glm/mat3x3.hpp>

#include "firmware/control/signal_path/kinematics.hpp"

namespace inkwell::kinematics {

/// Unit normal of the plane of the links, pointing to the right of an arm that faces the user.
glm::vec3 arm_side(float waist_rad, control::Frame frame);

/// The columns of the matrix are the stylus axes in the workspace. x points to the side of the stylus, and z points
/// from its tip to its back. `gimbal_rad`: yaw about the forearm, pitch about the axis perpendicular to the forearm,
/// roll about the stylus. With all gimbal angles at zero, the stylus is perpendicular to the forearm, in the arm's
/// plane, pointing away from the base. The signs follow OpenHaptics: negative yaw is to the right, positive pitch is
/// down, positive roll is clockwise.
glm::mat3 stylus_rotation(const std::array<float, 3>& joint_rad, const std::array<float, 3>& gimbal_rad,
                          const control::Arm& arm);

}  // namespace inkwell::kinematics
