// Computes the scene geometry with the firmware's code (inkwell_control).
#pragma once

#include <array>
#include <optional>

#include <glm/glm.hpp>

#include "firmware/control/signal_path/kinematics.hpp"
#include "host/client/device/wide_reports.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::window {

/// One of the six walls of the box.
struct WallView {
  int axis;             ///< 0: x, 1: y, 2: z
  bool upper;           ///< at the maximum of the box along this axis
  glm::vec3 inward;     ///< unit normal towards the free space
  float penetration_m;  ///< penetration depth of the sphere, 0 in free space
  bool pushes_back;     ///< in contact, and the force is on
};

/// Geometry of the scene. All vectors are in workspace axes.
struct SceneModel {
  glm::vec3 shoulder_m;
  glm::vec3 elbow_m;
  glm::vec3 probe_m;  ///< center of the sphere
  glm::vec3 proxy_m;  ///< proxy, where the sphere is drawn
  bool in_contact;
  float sphere_radius_m;
  glm::vec3 box_minimum_m;
  glm::vec3 box_maximum_m;
  std::array<WallView, 6> walls;  ///< x lower, x upper, y lower, ...
  glm::vec3 force_N;              ///< force that the device exerts on the hand
  glm::vec3 stylus_direction;     ///< from the probe to the end of the stylus in the hand
  glm::vec3 stylus_side;          ///< direction of the buttons
  glm::vec3 arm_side;             ///< normal of the plane of both links
  bool parallelogram;
  glm::vec3 inkwell_m;   ///< probe position while the stylus is in the inkwell
  float floor_height_m;  ///< along the vertical axis of the workspace
  control::Frame frame;
};

/// Computes the scene for a pose. Without a referenced pose, the stylus is in the inkwell.
SceneModel build_scene(const std::optional<device::Pose>& pose, const protocol::ParameterSet& parameters);

/// Returns true if the two poses look different in the scene.
bool differs_visibly(const std::optional<device::Pose>& a, const std::optional<device::Pose>& b);

/// Returns the rotation matrix from workspace axes to view space.
glm::mat3 workspace_to_view(control::Frame frame);

/// Returns the parameter that sets the position of a wall.
protocol::Parameter wall_parameter(int axis, bool upper);

/// Returns the position of a dragged wall, rounded to millimeters. The position is within the parameter's range and
/// leaves room for the sphere between the walls.
float dragged_wall_m(const protocol::ParameterSet& parameters, int axis, bool upper, float wanted_m);

}  // namespace inkwell::window
