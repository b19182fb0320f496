#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "host/feel/grab.hpp"

using namespace inkwell;

namespace {

constexpr double pi = 3.14159265358979;

double distance_m(const glm::dvec3& one_m, const glm::dvec3& other_m) { return glm::distance(one_m, other_m); }

}  // namespace

TEST_CASE("a grabbed object follows position and orientation of the stylus, and remains after the release") {
  contact::Object object{.id = 4, .shape = contact::Sphere{0.01}, .placement = {{0.03, 0, 0}}};
  feel::Grab grab;
  CHECK_FALSE(grab.is_holding());
  grab.begin(object, {{0.02, 0, 0}}, 0);
  CHECK(grab.object() == 4);
  grab.follow(object, {{0.02, 0.05, 0}}, 0.001);
  CHECK(distance_m(object.placement.position_m, {0.03, 0.05, 0}) < 1e-12);
  // A quarter turn about z carries the middle of the object around the tip.
  const glm::dquat quarter = glm::angleAxis(pi / 2, glm::dvec3{0, 0, 1});
  grab.follow(object, {{0.02, 0.05, 0}, quarter}, 0.002);
  CHECK(distance_m(object.placement.position_m, {0.02, 0.06, 0}) < 1e-12);
  CHECK(distance_m(object.placement.rotation * glm::dvec3{1, 0, 0}, {0, 1, 0}) < 1e-12);
  grab.end(object);
  CHECK_FALSE(grab.is_holding());
  CHECK(distance_m(object.placement.position_m, {0.02, 0.06, 0}) < 1e-12);
  CHECK_FALSE(object.moves());
}

TEST_CASE("velocity and spin of a grabbed object are those of the hand") {
  contact::Object object{.id = 4, .shape = contact::Sphere{0.01}};
  feel::Grab grab;
  grab.begin(object, {}, 0);
  constexpr double speed_m_per_s = 0.2, spin_rad_per_s = -3;
  for (int millisecond = 1; millisecond <= 40; ++millisecond) {
    const double time_s = 0.001 * millisecond;
    grab.follow(object, {{speed_m_per_s * time_s, 0, 0}, glm::angleAxis(spin_rad_per_s * time_s, glm::dvec3{0, 1, 0})},
                time_s);
  }
  CHECK(distance_m(object.velocity_m_per_s, {speed_m_per_s, 0, 0}) < 1e-9);
  CHECK(distance_m(object.spin_rad_per_s, {0, spin_rad_per_s, 0}) < 1e-9);
  // A hand at rest moves nothing after the span.
  for (int millisecond = 41; millisecond <= 50; ++millisecond)
    grab.follow(object, {{0.008, 0, 0}, glm::angleAxis(-0.12, glm::dvec3{0, 1, 0})}, 0.001 * millisecond);
  CHECK(glm::length(object.velocity_m_per_s) < 1e-9);
  CHECK(glm::length(object.spin_rad_per_s) < 1e-6);
}

TEST_CASE("poses that arrive late do not disturb the velocity of a grabbed object") {
  contact::Object object{.id = 4, .shape = contact::Sphere{0.01}};
  feel::Grab grab;
  grab.begin(object, {}, 5);
  grab.follow(object, {{0.1, 0, 0}}, 5.1);  // a gap longer than the span
  CHECK_FALSE(object.moves());
  grab.follow(object, {{0.1, 0, 0}}, 0);  // the board has restarted
  CHECK_FALSE(object.moves());
}
