// Compares the scene model with the arm's geometry: link lengths, wall reactions, frames and dragging.
#include <cmath>

#include <doctest/doctest.h>

#include "host/companion/window/scene/camera.hpp"
#include "host/companion/window/scene/scene_model.hpp"

using namespace inkwell;
using protocol::Parameter;
using window::SceneModel;

namespace {

device::Pose pose_at(float joint_1_rad, float joint_2_rad, float joint_3_rad, protocol::State state) {
  device::Pose pose{};
  pose.state = state;
  pose.is_referenced = state == protocol::State::ready || protocol::force_is_on(state);
  pose.joint_rad[0] = joint_1_rad;
  pose.joint_rad[1] = joint_2_rad;
  pose.joint_rad[2] = joint_3_rad;
  return pose;
}

// Joint angles that place the Omni's probe near the middle of its box.
device::Pose middle_pose(protocol::State state) { return pose_at(0.0f, 0.4f, 0.4f, state); }

}  // namespace

TEST_CASE("the links have the lengths of the arm") {
  const auto parameters = protocol::default_parameters();
  const SceneModel scene = window::build_scene(pose_at(0.3f, 0.8f, 0.5f, protocol::State::ready), parameters);
  CHECK(glm::length(scene.elbow_m - scene.shoulder_m) ==
        doctest::Approx(parameters[Parameter::link_2_m]).scale(0).epsilon(1e-4));
  CHECK(glm::length(scene.probe_m - scene.elbow_m) ==
        doctest::Approx(parameters[Parameter::link_3_m]).scale(0).epsilon(1e-4));
  CHECK(std::abs(glm::dot(scene.arm_side, scene.elbow_m - scene.shoulder_m)) < 1e-5f);
  CHECK(std::abs(glm::dot(scene.arm_side, scene.probe_m - scene.elbow_m)) < 1e-5f);
}

TEST_CASE("until the arm has been in the inkwell it is drawn there") {
  const auto parameters = protocol::default_parameters();
  const SceneModel scene = window::build_scene(pose_at(0.9f, 1.5f, 0.9f, protocol::State::unreferenced), parameters);
  CHECK(glm::length(scene.probe_m - scene.inkwell_m) < 1e-6f);
  CHECK_FALSE(scene.in_contact);
}

TEST_CASE("in a fault, the scene draws the arm at its pose while the encoders are referenced") {
  const auto parameters = protocol::default_parameters();
  const glm::vec3 expected_m = window::build_scene(middle_pose(protocol::State::ready), parameters).probe_m;
  auto pose = middle_pose(protocol::State::fault);
  pose.fault = protocol::Fault::supply_low;
  SceneModel scene = window::build_scene(pose, parameters);
  CHECK(glm::length(scene.probe_m - scene.inkwell_m) < 1e-6f);
  pose.is_referenced = true;
  scene = window::build_scene(pose, parameters);
  CHECK(glm::length(scene.probe_m - expected_m) < 1e-6f);
  CHECK(glm::length(scene.probe_m - scene.inkwell_m) > 0.02f);
}

TEST_CASE("a wall pushes back when the sphere is in it and the force is on") {
  auto parameters = protocol::default_parameters();
  const SceneModel before = window::build_scene(middle_pose(protocol::State::active), parameters);
  REQUIRE_FALSE(before.in_contact);
  // Moves the upper x wall inward until the sphere is 3 mm inside the wall.
  parameters[Parameter::box_maximum_x_m] = before.probe_m.x + parameters[Parameter::sphere_radius_m] - 0.003f;

  const SceneModel active = window::build_scene(middle_pose(protocol::State::active), parameters);
  CHECK(active.in_contact);
  CHECK(active.probe_m.x - active.proxy_m.x == doctest::Approx(0.003).scale(0).epsilon(1e-3));
  for (const window::WallView& wall : active.walls) {
    const bool touched = wall.axis == 0 && wall.upper;
    CHECK(wall.pushes_back == touched);
    CHECK(wall.penetration_m == doctest::Approx(touched ? 0.003 : 0.0).epsilon(1e-3));
  }
  const SceneModel ready = window::build_scene(middle_pose(protocol::State::ready), parameters);
  CHECK(ready.in_contact);
  for (const window::WallView& wall : ready.walls) CHECK_FALSE(wall.pushes_back);
}

TEST_CASE("the stylus is square on the forearm with the gimbal at zero, and turns with the yaw") {
  const auto parameters = protocol::default_parameters();
  auto pose = middle_pose(protocol::State::ready);
  const SceneModel straight = window::build_scene(pose, parameters);
  const glm::vec3 forearm = glm::normalize(straight.probe_m - straight.elbow_m);
  CHECK(std::abs(glm::dot(straight.stylus_direction, forearm)) < 1e-5f);
  CHECK(straight.stylus_direction.z > 0.0f);  // away from the base, toward the user
  pose.gimbal_rad[0] = 0.5f;
  const SceneModel turned = window::build_scene(pose, parameters);
  CHECK(glm::dot(turned.stylus_direction, straight.stylus_direction) == doctest::Approx(std::cos(0.5)).epsilon(1e-4));
}

TEST_CASE("both frames show up upwards and the user in front") {
  const glm::mat3 omni = window::workspace_to_view(control::Frame::omni);
  const glm::mat3 paper = window::workspace_to_view(control::Frame::paper);
  CHECK(omni * glm::vec3{0, 1, 0} == glm::vec3{0, 1, 0});
  CHECK(paper * glm::vec3{0, 0, 1} == glm::vec3{0, 1, 0});
  CHECK(paper * glm::vec3{1, 0, 0} == glm::vec3{0, 0, 1});
  CHECK(glm::determinant(paper) == doctest::Approx(1.0));  // a rotation without reflection
}

TEST_CASE("a dragged wall leaves room for the sphere and stays in its range") {
  const auto parameters = protocol::default_parameters();
  const float room_m = 2.0f * parameters[Parameter::sphere_radius_m];
  const float close_m = window::dragged_wall_m(parameters, 0, true, -0.3f);
  CHECK(close_m > parameters[Parameter::box_minimum_x_m] + room_m);
  CHECK(window::dragged_wall_m(parameters, 0, true, 2.0f) == protocol::info(Parameter::box_maximum_x_m).maximum);
  CHECK(window::dragged_wall_m(parameters, 1, false, -0.0504f) == doctest::Approx(-0.050));
}

TEST_CASE("a ray through a projected point meets that point") {
  const window::Camera camera = window::look_at_box({-0.08f, -0.09f, -0.09f}, {0.08f, 0.09f, 0.04f});
  const glm::vec2 size{900.0f, 470.0f};
  const glm::vec3 point{0.03f, -0.02f, 0.01f};
  const glm::vec3 pixel = camera.project(point, size);
  const glm::vec3 met = window::on_view_plane(camera, camera.ray({pixel.x, pixel.y}, size), point);
  CHECK(glm::length(met - point) < 1e-4f);
  const glm::vec3 x_axis{1.0f, 0.0f, 0.0f};
  const glm::vec3 moved = camera.project(point + 0.02f * x_axis, size);
  CHECK(window::nearest_on_line(camera.ray({moved.x, moved.y}, size), point, x_axis) ==
        doctest::Approx(0.02).scale(0).epsilon(1e-2));
}

TEST_CASE("the camera never turns over and never leaves its distances") {
  window::Camera camera;
  camera.orbit(100.0f, 100.0f);
  CHECK(camera.elevation_rad < 1.58f);
  CHECK(std::abs(camera.azimuth_rad) <= 3.15f);
  camera.zoom(1000.0f);
  CHECK(camera.distance_m > 0.05f);
  camera.zoom(-1000.0f);
  CHECK(camera.distance_m < 3.1f);
}

TEST_CASE("differs_visibly returns true only for a visible difference between two poses") {
  device::Pose a{};
  device::Pose b = a;
  b.sequence = 77;
  b.servo_load = 9;
  b.position_m[1] = 1e-4f;
  CHECK_FALSE(window::differs_visibly(a, b));
  SUBCASE("position") { b.position_m[1] = 1e-3f; }
  SUBCASE("force") { b.force_N[2] = 0.1f; }
  SUBCASE("stylus") { b.gimbal_rad[0] = 0.1f; }
  SUBCASE("state") { b.state = protocol::State::fault; }
  SUBCASE("its reference is lost") { b.is_referenced = !a.is_referenced; }
  CHECK(window::differs_visibly(a, b));
  CHECK(window::differs_visibly(a, std::nullopt));
}
