#include <doctest/doctest.h>

#include <memory>

#include <glm/geometric.hpp>

#include "host/feel/servo.hpp"

using namespace inkwell;

namespace {

constexpr double ball_radius_m = 0.03;
constexpr double tip_radius_m = 0.005;
constexpr std::uint32_t ball = 9;

/// A servo, and a hand above a ball at the origin.
struct ServoRig {
  ServoRig() {
    parameters[protocol::Parameter::sphere_radius_m] = static_cast<float>(tip_radius_m);
    auto scene = std::make_shared<contact::Scene>();
    scene->objects.push_back({.id = ball, .shape = contact::Sphere{ball_radius_m}});
    scene->objects.front().material = 2;
    publication.publish(scene);
    pose.is_referenced = true;
    pose.state = protocol::State::active;
  }

  /// One pose at this height above the middle of the ball.
  std::optional<device::LocalModel> at(double height_m, double aside_m = 0, bool is_newest = true) {
    pose.position_m[0] = static_cast<float>(aside_m);
    pose.position_m[2] = static_cast<float>(height_m);
    ++pose.sequence;
    pose.time_periods += protocol::servo_rate_Hz / 1000;
    return servo.step({pose, parameters, revision, pose.sequence == 1, is_newest});
  }
  /// Ten poses at this height, so that the measured velocity is 0.
  std::optional<device::LocalModel> rest_at(double height_m) {
    for (int pose_number = 1; pose_number < 10; ++pose_number) at(height_m);
    return at(height_m);
  }
  void press_button(bool is_pressed) {
    pose.switches = is_pressed ? static_cast<std::uint8_t>(protocol::Switch::button_1) : 0;
  }

  contact::Publication publication;
  feel::Servo servo{publication};
  device::Pose pose{};
  protocol::ParameterSet parameters = protocol::default_parameters();
  std::uint64_t revision = 1;
};

}  // namespace

TEST_CASE("the servo returns a model near an object, one empty model behind it, and none in free space") {
  ServoRig rig;
  CHECK_FALSE(rig.at(0.06));
  const auto model = rig.rest_at(0.034);
  REQUIRE(model);
  REQUIRE(model->count == 1);
  CHECK(model->features[0].kind == protocol::FeatureKind::sphere);
  CHECK(model->features[0].radius_m == doctest::Approx(ball_radius_m + tip_radius_m));
  CHECK(model->features[0].material == 2);
  const feel::ServoView view = rig.servo.view();
  REQUIRE(view.contact_count == 1);
  CHECK(view.contacts[0].object == ball);
  CHECK(view.contacts[0].depth_m == doctest::Approx(0.001).epsilon(1e-3));
  CHECK(view.contacts[0].normal.z == doctest::Approx(1));
  CHECK(view.counters.steps == 11);
  const auto empty = rig.at(0.06);
  REQUIRE(empty);
  CHECK(empty->count == 0);
  CHECK_FALSE(rig.at(0.06));
}

TEST_CASE("the servo answers only the newest of several poses, and none without force or position") {
  ServoRig rig;
  rig.at(0.06);
  CHECK_FALSE(rig.at(0.034, 0, false));
  CHECK(rig.at(0.034));
  rig.pose.state = protocol::State::ready;
  CHECK_FALSE(rig.at(0.034));
  rig.pose.state = protocol::State::active;
  rig.pose.is_referenced = false;
  CHECK_FALSE(rig.at(0.034));
  rig.pose.state = protocol::State::active;
  rig.pose.is_referenced = true;
  rig.at(0.06);
  rig.at(0.034);
  CHECK(rig.servo.view().contact_count == 1);
  rig.pose.is_referenced = false;
  rig.at(0.034);
  CHECK(rig.servo.view().contact_count == 0);
}

TEST_CASE("with friction, the model belongs to the proxy of the board, which a force without a limit shows") {
  ServoRig rig;
  auto scene = std::make_shared<contact::Scene>();
  scene->objects.push_back({.id = ball, .shape = contact::Plane{}});
  scene->materials[0] = {.stiffness_N_per_m = 500, .static_friction = 1, .dynamic_friction = 1};
  rig.publication.publish(scene);
  rig.at(0.02);
  rig.at(0.004);
  rig.pose.force_N[0] = 0.2f;
  rig.pose.force_N[2] = 0.5f;
  double proxy_m = 0.0004;
  SUBCASE("without a limit") {}
  SUBCASE("with a limit") {
    rig.pose.limits = static_cast<std::uint8_t>(protocol::Limit::force);
    proxy_m = 0;
  }
  rig.at(0.004);
  const feel::ServoView view = rig.servo.view();
  REQUIRE(view.contact_count == 1);
  CHECK(view.contacts[0].point_m.x == doctest::Approx(proxy_m).scale(1).epsilon(1e-6));
}

TEST_CASE("friction holds the proxy only as far as the force limit of the board can") {
  ServoRig rig;
  auto scene = std::make_shared<contact::Scene>();
  scene->objects.push_back({.id = ball, .shape = contact::Plane{}});
  scene->materials[0] = {.stiffness_N_per_m = 500, .static_friction = 1, .dynamic_friction = 1};
  rig.publication.publish(scene);
  rig.parameters[protocol::Parameter::force_limit_N] = 0.1f;
  rig.at(0.02);
  rig.at(0.004);
  rig.at(0.004, 0.0005);
  CHECK(rig.servo.newest_step().proxy_m.x == doctest::Approx(0.0005 - 0.1 / 500).scale(0).epsilon(0.01));
}

TEST_CASE("a hand in the object is free when the force is switched on, until it has left the object") {
  ServoRig rig;
  rig.pose.state = protocol::State::ready;
  rig.at(0.06);
  rig.at(0.02);
  rig.pose.state = protocol::State::active;
  CHECK_FALSE(rig.at(0.02));
  CHECK(rig.servo.view().contact_count == 0);
  rig.at(0.06);
  rig.at(0.034);
  CHECK(rig.servo.view().contact_count == 1);
}

TEST_CASE("the tip has the radius of the parameter, and at least half a millimeter") {
  ServoRig rig;
  rig.at(0.06);
  rig.parameters[protocol::Parameter::sphere_radius_m] = 0;
  SUBCASE("after a change") { ++rig.revision; }
  SUBCASE("of another device") { rig.pose.sequence = 0; }
  rig.at(0.06);
  const auto model = rig.rest_at(0.0304);
  REQUIRE(model);
  CHECK(model->features[0].radius_m == doctest::Approx(ball_radius_m + contact::tip_radius_min_m));
}

TEST_CASE("the button grabs the touched object, which follows the hand and is not felt, until the button is released") {
  ServoRig rig;
  rig.at(0.06);
  rig.press_button(true);
  rig.at(0.06);  // touches nothing, so there is nothing to grab
  CHECK_FALSE(rig.servo.view().held);
  rig.press_button(false);
  rig.at(0.034);
  rig.press_button(true);
  // The force of the touched object fades: no model ends it.
  CHECK_FALSE(rig.at(0.034));
  CHECK(rig.servo.view().held == ball);
  CHECK(rig.servo.view().contact_count == 0);
  for (int millisecond = 1; millisecond <= 20; ++millisecond) CHECK_FALSE(rig.at(0.034, 0.001 * millisecond));
  const auto placed = rig.servo.view().objects[0];
  CHECK(placed.id == ball);
  CHECK(glm::distance(placed.placement.position_m, {0.02, 0, 0}) < 1e-6);

  rig.press_button(false);
  CHECK_FALSE(rig.at(0.034, 0.02));
  CHECK_FALSE(rig.servo.view().held);
  rig.at(0.034, 0.03);
  CHECK(glm::distance(rig.servo.view().objects[0].placement.position_m, {0.02, 0, 0}) < 1e-6);
  rig.at(0.06, 0.02);
  rig.at(0.034, 0.02);  // the tip has left the ball and touches it again
  CHECK(rig.servo.view().contact_count == 1);
}

TEST_CASE("a new scene replaces the objects, and a removed object is not held") {
  ServoRig rig;
  rig.at(0.06);
  rig.at(0.034);
  rig.press_button(true);
  rig.at(0.034);
  REQUIRE(rig.servo.view().held);
  rig.publication.publish(std::make_shared<contact::Scene>());
  rig.at(0.034);
  CHECK(rig.servo.view().object_count == 0);
  CHECK_FALSE(rig.servo.view().held);
}

TEST_CASE("a servo without a scene does nothing") {
  contact::Publication publication;
  feel::Servo servo(publication);
  device::Pose pose{};
  pose.is_referenced = true;
  pose.state = protocol::State::active;
  const protocol::ParameterSet parameters = protocol::default_parameters();
  CHECK_FALSE(servo.step({pose, parameters, 1, true, true}));
  CHECK(servo.view().counters.steps == 0);
}

TEST_CASE("an object with a velocity moves from its placement for 20 ms of board time, and then stops") {
  ServoRig rig;
  rig.at(0.06);
  auto scene = std::make_shared<contact::Scene>();
  scene->objects.push_back({.id = ball, .shape = contact::Sphere{ball_radius_m}, .velocity_m_per_s = {0, 0, 0.1}});
  rig.publication.publish(scene);
  const auto height_m = [&] { return rig.servo.view().objects[0].placement.position_m.z; };
  std::optional<device::LocalModel> model;
  for (int millisecond = 0; millisecond < 19; ++millisecond) {
    model = rig.at(0.034);
    CHECK(height_m() == doctest::Approx(0.0001 * millisecond).epsilon(1e-6));
  }
  REQUIRE(model);
  CHECK(model->features[0].moves);
  CHECK(model->velocity_m_per_s[2] == doctest::Approx(0.1));
  for (int millisecond = 0; millisecond < 10; ++millisecond) model = rig.at(0.036);
  CHECK(height_m() == doctest::Approx(0.002));
  REQUIRE(model);
  CHECK_FALSE(model->features[0].moves);
  CHECK(rig.servo.view().time_s == doctest::Approx(device::board_time_s(rig.pose.time_periods)));
}

TEST_CASE("a servo without grabbing feels the touched object also while the button is pressed") {
  ServoRig rig;
  feel::Servo servo(rig.publication, feel::ButtonUse::none);
  const auto step = [&](double height_m) {
    rig.pose.position_m[2] = static_cast<float>(height_m);
    ++rig.pose.sequence;
    return servo.step({rig.pose, rig.parameters, rig.revision, rig.pose.sequence == 1, true});
  };
  step(0.06);
  step(0.034);
  rig.press_button(true);
  CHECK(step(0.034));
  CHECK_FALSE(servo.view().held);
  CHECK(servo.newest_step().contact_count == 1);
}
