// A hand at a scene, for the tests of contact.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "host/contact/step.hpp"
#include "host/geometry/examples.hpp"

namespace inkwell::contact {

inline std::shared_ptr<const geometry::Surface> surface_of(const geometry::Mesh& mesh) {
  return geometry::Surface::build(geometry::weld(mesh.vertices_m, mesh.faces));
}

inline Scene scene_with(const Shape& shape, bool is_smooth = false) {
  Scene scene;
  scene.objects.emplace_back();
  scene.objects[0].id = 5;
  scene.objects[0].shape = shape;
  scene.objects[0].material = 3;
  scene.objects[0].is_smooth = is_smooth;
  return scene;
}

/// Moves in steps of 1 ms.
struct Hand {
  Scene scene;
  Tool tool;
  Pose pose;
  Step last;

  Hand(Scene objects, double radius_m, const glm::dvec3& start_m) : scene(std::move(objects)) {
    tool.radius_m = radius_m;
    pose.position_m = start_m;
    last = step(scene, tool, pose);
  }

  const Step& go(const glm::dvec3& position_m) {
    pose.velocity_m_per_s = (position_m - pose.position_m) / 0.001;
    pose.position_m = position_m;
    return last = step(scene, tool, pose);
  }

  /// In steps of at most this length.
  const Step& go_straight(const glm::dvec3& goal_m, double step_m = 0.0001) {
    const glm::dvec3 start_m = pose.position_m;
    const double count = std::ceil(glm::distance(start_m, goal_m) / step_m);
    for (double number = 1; number <= count; ++number) go(start_m + (goal_m - start_m) * (number / count));
    return last;
  }

  const Step& stay(int steps) {
    for (int count = 0; count < steps; ++count) go(pose.position_m);
    return last;
  }

  glm::dvec3 stretch_m() const { return last.proxy_m - pose.position_m; }
};

}  // namespace inkwell::contact
