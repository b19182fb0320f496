#include "host/client/kinematics/stylus.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace inkwell::kinematics {
namespace {

glm::vec3 turned(glm::vec3 vector, glm::vec3 axis, float angle_rad) {
  return vector * std::cos(angle_rad) + glm::cross(axis, vector) * std::sin(angle_rad) +
         axis * glm::dot(axis, vector) * (1.0f - std::cos(angle_rad));
}

glm::vec3 to_glm(const control::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

}  // namespace

glm::vec3 arm_side(float waist_rad, control::Frame frame) {
  // The waist angle defines the plane, because collinear links do not.
  const bool paper = frame == control::Frame::paper;
  const glm::vec3 up = paper ? glm::vec3{0, 0, 1} : glm::vec3{0, 1, 0};
  const glm::vec3 forward = paper ? glm::vec3{std::cos(waist_rad), std::sin(waist_rad), 0.0f}
                                  : glm::vec3{-std::sin(waist_rad), 0.0f, std::cos(waist_rad)};
  return glm::normalize(glm::cross(up, forward));
}

glm::mat3 stylus_rotation(const std::array<float, 3>& joint_rad, const std::array<float, 3>& gimbal_rad,
                          const control::Arm& arm) {
  const control::LinkEnds ends = control::link_ends(joint_rad, arm);
  const glm::vec3 forearm = glm::normalize(to_glm(ends.probe_m) - to_glm(ends.elbow_m));
  const glm::vec3 side = arm_side(joint_rad[0], arm.frame);
  const glm::vec3 across = turned(side, forearm, gimbal_rad[0]);
  const glm::vec3 outward = turned(turned(glm::cross(forearm, side), forearm, gimbal_rad[0]), across, gimbal_rad[1]);
  const glm::vec3 x = turned(across, outward, gimbal_rad[2]);
  return {x, glm::cross(outward, x), outward};
}

}  // namespace inkwell::kinematics
