// What the scene shows, as geometry: computed from the newest pose and the parameters by the same code that the
// firmware runs (inkwell_control), so that the picture cannot disagree with the device.
#pragma once

#include <array>
#include <optional>

#include <glm/glm.hpp>

#include <control/kinematics.hpp>
#include <device/wide_reports.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::window {

/// One of the six walls of the box.
struct WallView {
  int axis;             ///< 0 x, 1 y, 2 z
  bool upper;           ///< at the box's maximum along that axis
  glm::vec3 inward;     ///< unit normal into the free space
  float penetration_m;  ///< how deep the sphere is in it, 0 in free space
  bool pushes_back;     ///< in contact while the device's force is on
};

/// Everything in workspace axes and metres.
struct SceneModel {
  glm::vec3 shoulder_m;
  glm::vec3 elbow_m;
  glm::vec3 probe_m;  ///< centre of the sphere
  glm::vec3 proxy_m;  ///< centre of the sphere as the walls would have it
  bool in_contact;
  float sphere_radius_m;
  glm::vec3 box_minimum_m;
  glm::vec3 box_maximum_m;
  std::array<WallView, 6> walls;  ///< x lower, x upper, y lower, ...
  glm::vec3 force_N;              ///< on the hand, as the device asks it of the motors
  glm::vec3 stylus_direction;     ///< from the probe to the end that the hand holds
  glm::vec3 stylus_side;          ///< where the buttons are
  glm::vec3 arm_side;             ///< normal of the plane in which both links lie
  bool parallelogram;
  glm::vec3 inkwell_m;   ///< where the probe is while the stylus is in the inkwell
  float floor_height_m;  ///< along the frame's vertical axis
  control::Frame frame;
};

/// The picture of a pose. Without a referenced pose the arm is drawn in the inkwell.
SceneModel build_scene(const std::optional<device::Pose>& pose, const protocol::ParameterSet& parameters);

/// True if a person could see the difference in the scene.
bool looks_different(const std::optional<device::Pose>& a, const std::optional<device::Pose>& b);

/// Rotation from workspace axes to view space (x right, y up, z to the user), which differs by the frame.
glm::mat3 workspace_to_view(control::Frame frame);

/// The pair of parameters that place a wall, so that it can be dragged.
protocol::Parameter wall_parameter(int axis, bool upper);

/// A wall's place along its axis after a drag, in whole millimetres: within the parameter's range, and leaving room
/// for the sphere between the two walls.
float dragged_wall_m(const protocol::ParameterSet& parameters, int axis, bool upper, float wanted_m);

}  // namespace inkwell::window
