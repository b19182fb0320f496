#include "host/companion/window/scene/scene_model.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/control/settings.hpp"
#include "firmware/control/signal_path/contact.hpp"
#include "host/client/kinematics/stylus.hpp"

namespace inkwell::window {

using protocol::Parameter;

namespace {

constexpr float clearance_m = 0.005f;
constexpr float base_height_m = 0.115f;  // height of the shoulder above the table

glm::vec3 to_glm(const control::Vector3& vector) { return {vector.x, vector.y, vector.z}; }
glm::vec3 to_glm(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

glm::vec3 up_of(control::Frame frame) {
  return frame == control::Frame::paper ? glm::vec3{0, 0, 1} : glm::vec3{0, 1, 0};
}

}  // namespace

glm::mat3 workspace_to_view(control::Frame frame) {
  if (frame == control::Frame::omni) return glm::mat3{1.0f};
  // In the frame `paper`, x points from the base to the user, y to the right of the user, and z up. Each matrix column
  // is an axis in view space.
  return {glm::vec3{0, 0, 1}, glm::vec3{1, 0, 0}, glm::vec3{0, 1, 0}};
}

SceneModel build_scene(const std::optional<device::Pose>& pose, const protocol::ParameterSet& parameters) {
  const control::Settings settings = control::prepare(parameters);
  const control::Triple inkwell_rad{parameters[Parameter::inkwell_joint_1_rad],
                                    parameters[Parameter::inkwell_joint_2_rad],
                                    parameters[Parameter::inkwell_joint_3_rad]};
  const bool posed = pose && pose->is_referenced;
  const control::Triple joint_rad =
      posed ? control::Triple{pose->joint_rad[0], pose->joint_rad[1], pose->joint_rad[2]} : inkwell_rad;
  const control::LinkEnds ends = control::link_ends(joint_rad, settings.arm);
  const control::Contact contact = control::find_contact(ends.probe_m, settings.box);

  SceneModel scene{};
  scene.frame = settings.arm.frame;
  scene.shoulder_m = to_glm(ends.shoulder_m);
  scene.elbow_m = to_glm(ends.elbow_m);
  scene.probe_m = to_glm(ends.probe_m);
  scene.proxy_m = to_glm(contact.proxy_m);
  scene.sphere_radius_m = parameters[Parameter::sphere_radius_m];
  scene.parallelogram = settings.arm.transmission == control::Transmission::parallelogram;
  scene.inkwell_m = to_glm(control::link_ends(inkwell_rad, settings.arm).probe_m);
  scene.force_N = posed ? to_glm(pose->force_N) : glm::vec3{0.0f};

  const glm::vec3 penetration_m = to_glm(contact.penetration_m);
  scene.in_contact = posed && glm::length(penetration_m) > 0.0f;
  const bool force_is_on = posed && protocol::force_is_on(pose->state);
  for (int axis = 0; axis < 3; ++axis) {
    scene.box_minimum_m[axis] = parameters[wall_parameter(axis, false)];
    scene.box_maximum_m[axis] = parameters[wall_parameter(axis, true)];
    for (bool upper : {false, true}) {
      WallView& wall = scene.walls[static_cast<std::size_t>(2 * axis + (upper ? 1 : 0))];
      wall = {axis, upper, glm::vec3{0.0f}, 0.0f, false};
      wall.inward[axis] = upper ? -1.0f : 1.0f;
      wall.penetration_m = posed ? std::max(0.0f, penetration_m[axis] * wall.inward[axis]) : 0.0f;
      wall.pushes_back = force_is_on && wall.penetration_m > 0.0f;
    }
  }

  const glm::vec3 up = up_of(scene.frame);
  scene.arm_side = kinematics::arm_side(joint_rad[0], scene.frame);
  const std::array<float, 3> gimbal_rad =
      pose ? std::array{pose->gimbal_rad[0], pose->gimbal_rad[1], pose->gimbal_rad[2]} : std::array<float, 3>{};
  const glm::mat3 stylus = kinematics::stylus_rotation(joint_rad, gimbal_rad, settings.arm);
  scene.stylus_side = stylus[0];
  scene.stylus_direction = stylus[2];

  scene.floor_height_m = std::min({glm::dot(scene.shoulder_m, up) - base_height_m,
                                   glm::dot(scene.inkwell_m, up) - 0.03f, glm::dot(scene.box_minimum_m, up) - 0.012f});
  return scene;
}

Parameter wall_parameter(int axis, bool upper) {
  const auto index = static_cast<std::size_t>(axis);
  return upper ? of_axis(Parameter::box_maximum_x_m, index) : of_axis(Parameter::box_minimum_x_m, index);
}

float dragged_wall_m(const protocol::ParameterSet& parameters, int axis, bool upper, float wanted_m) {
  const auto& info = protocol::info(wall_parameter(axis, upper));
  const float opposite_m = parameters[wall_parameter(axis, !upper)];
  const float room_m = 2.0f * parameters[Parameter::sphere_radius_m] + clearance_m;
  const float wanted_whole_mm = std::round(wanted_m * 1000.0f) / 1000.0f;
  return upper ? std::clamp(wanted_whole_mm, std::min(opposite_m + room_m, info.maximum), info.maximum)
               : std::clamp(wanted_whole_mm, info.minimum, std::max(opposite_m - room_m, info.minimum));
}

bool differs_visibly(const std::optional<device::Pose>& first, const std::optional<device::Pose>& second) {
  if (!first || !second) return first.has_value() != second.has_value();
  const device::Pose& a = *first;
  const device::Pose& b = *second;
  constexpr float visible_m = 2e-4f;
  constexpr float visible_N = 0.02f;
  constexpr float visible_rad = 0.02f;
  if (a.state != b.state || a.fault != b.fault || a.switches != b.switches || a.is_referenced != b.is_referenced)
    return true;
  for (int i = 0; i < 3; ++i)
    if (std::abs(a.position_m[i] - b.position_m[i]) > visible_m || std::abs(a.force_N[i] - b.force_N[i]) > visible_N ||
        std::abs(a.gimbal_rad[i] - b.gimbal_rad[i]) > visible_rad)
      return true;
  return false;
}

}  // namespace inkwell::window
