#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "firmware/control/settings.hpp"
#include "host/client/kinematics/stylus.hpp"
#include "protocol/parameters.hpp"

namespace inkwell {
namespace {

constexpr float quarter_rad = std::numbers::pi_v<float> / 2;

control::Arm arm() { return control::prepare(protocol::default_parameters()).arm; }

/// The forearm points down and joint 1 points forward.
std::array<float, 3> hanging() { return {0.0f, 0.0f, -arm().elbow_offset_rad - quarter_rad}; }

void check_close(const glm::vec3& is, const glm::vec3& expected) { CHECK(glm::length(is - expected) < 1e-5f); }

}  // namespace

TEST_CASE("with the gimbal at zero the stylus points from the base to the user, its side to the right") {
  const glm::mat3 rotation = kinematics::stylus_rotation(hanging(), {}, arm());
  check_close(rotation[0], {1, 0, 0});
  check_close(rotation[1], {0, 1, 0});
  check_close(rotation[2], {0, 0, 1});
}

TEST_CASE("the waist takes the stylus with it") {
  auto joint_rad = hanging();
  joint_rad[0] = quarter_rad;
  // A positive angle of joint 1 turns the stylus from the user's direction toward -x.
  check_close(kinematics::stylus_rotation(joint_rad, {}, arm())[2], {-1, 0, 0});
}

TEST_CASE("yaw, pitch and roll turn about forearm, side and stylus, with the signs of OpenHaptics") {
  const auto stylus = [](std::array<float, 3> gimbal_rad) {
    return kinematics::stylus_rotation(hanging(), gimbal_rad, arm());
  };
  // The third column of the rotation is the direction of the back of the stylus.
  check_close(stylus({quarter_rad, 0, 0})[2], {-1, 0, 0});
  check_close(stylus({0, quarter_rad, 0})[2], {0, -1, 0});
  check_close(stylus({0, 0, quarter_rad})[2], {0, 0, 1});
  check_close(stylus({0, 0, quarter_rad})[0], {0, 1, 0});
}

TEST_CASE("the stylus axes form a right-handed frame for any angles") {
  for (int i = 0; i < 200; ++i) {
    const auto angle = [i](int part) { return 0.37f * static_cast<float>((i * part) % 17 - 8); };
    const glm::mat3 rotation = kinematics::stylus_rotation({angle(3), 0.3f * angle(5), -1.0f + 0.1f * angle(7)},
                                                           {angle(2), 0.2f * angle(11), angle(13)}, arm());
    for (int axis = 0; axis < 3; ++axis) CHECK(glm::length(rotation[axis]) == doctest::Approx(1.0).epsilon(1e-5));
    check_close(glm::cross(rotation[0], rotation[1]), rotation[2]);
  }
}

}  // namespace inkwell
