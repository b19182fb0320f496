#include <doctest/doctest.h>

#include <cmath>

#include "firmware/control/signal_path/contact.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::Box;
using control::Contact;
using control::Force;
using control::Vector3;
using control::Wall;

constexpr Box box{{-0.05f, -0.06f, -0.07f}, {0.05f, 0.06f, 0.07f}};
constexpr Wall wall{.stiffness_N_per_m = 800.0f, .damping_Ns_per_m = 2.0f};

TEST_CASE("inside the box the proxy is the probe and there is no force, however fast") {
  const Vector3 probe{0.049f, -0.059f, 0.069f};
  const Contact contact = control::find_contact(probe, box);
  CHECK(contact.proxy_m == probe);
  CHECK(contact.penetration_m == Vector3{});
  CHECK(control::wall_force_N(contact, {3.0f, -3.0f, 3.0f}, wall) == Vector3{});
}

TEST_CASE("each of the six walls pushes back along its own axis") {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      CAPTURE(axis);
      CAPTURE(side);
      const float bound_m = axis == 0 ? 0.05f : (axis == 1 ? 0.06f : 0.07f);
      const auto along = [&](float value) {
        return Vector3{axis == 0 ? value : 0.0f, axis == 1 ? value : 0.0f, axis == 2 ? value : 0.0f};
      };
      const Contact contact = control::find_contact(along(side * (bound_m + 0.001f)), box);
      const Vector3 force_N = control::wall_force_N(contact, {}, wall);
      const float component = control::dot(force_N, along(1.0f));
      CHECK(component == doctest::Approx(-side * 0.8f).epsilon(1e-4));
      CHECK(control::dot(force_N, force_N) == doctest::Approx(component * component));
    }
}

TEST_CASE("edges and corners are contact on two and three axes") {
  const Contact corner = control::find_contact({0.051f, -0.062f, 0.073f}, box);
  CHECK(corner.proxy_m == Vector3{0.05f, -0.06f, 0.07f});
  const Vector3 force_N = control::wall_force_N(corner, {}, wall);
  CHECK(force_N.x == doctest::Approx(-0.8f).epsilon(1e-3));
  CHECK(force_N.y == doctest::Approx(1.6f).epsilon(1e-3));
  CHECK(force_N.z == doctest::Approx(-2.4f).epsilon(1e-3));
  const Contact edge = control::find_contact({0.051f, 0.061f, 0.0f}, box);
  CHECK(control::wall_force_N(edge, {}, wall).z == 0.0f);
}

TEST_CASE("the damper resists the motion into the wall: F = k d + c d'") {
  const Contact contact = control::find_contact({0.051f, 0.0f, 0.0f}, box);
  const Vector3 force_N = control::wall_force_N(contact, {0.2f, 0.0f, 0.0f}, wall);
  CHECK(force_N.x == doctest::Approx(-(800.0f * 0.001f + 2.0f * 0.2f)).epsilon(1e-4));
}

TEST_CASE("a wall never pulls at any velocity of the probe") {
  tests::Random random{11};
  int pulled_back = 0, let_go = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 probe{random.between(-0.055f, 0.055f), random.between(-0.065f, 0.065f),
                        random.between(-0.075f, 0.075f)};
    const Vector3 velocity{random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
    const Contact contact = control::find_contact(probe, box);
    const Vector3 force_N = control::wall_force_N(contact, velocity, wall);
    const Vector3& out = contact.penetration_m;
    if (force_N.x * out.x < 0 || force_N.y * out.y < 0 || force_N.z * out.z < 0) ++pulled_back;
    if (out.x != 0 && force_N.x == 0) ++let_go;
    // An axis without contact has no force, even while another axis is in contact.
    if (out.x == 0) CHECK(force_N.x == 0.0f);
  }
  CHECK(pulled_back == 0);
  CHECK(let_go > 0);
}

TEST_CASE("the magnitude is bounded and the direction stays") {
  const Force force = control::bounded({-32.0f, 0.0f, 24.0f}, 3.3f);
  CHECK(force.magnitude_N == 3.3f);
  CHECK(std::sqrt(control::dot(force.force_N, force.force_N)) == doctest::Approx(3.3f).epsilon(1e-6));
  CHECK(force.force_N.x / force.force_N.z == doctest::Approx(-4.0f / 3.0f).epsilon(1e-4));
  CHECK(control::bounded({0.6f, 0.0f, -0.8f}, 3.3f).force_N == Vector3{0.6f, 0.0f, -0.8f});
  CHECK(control::bounded({0.6f, 0.0f, -0.8f}, 3.3f).magnitude_N == doctest::Approx(1.0f).epsilon(1e-6));
  CHECK(control::bounded({}, 3.3f).magnitude_N == 0.0f);
}

TEST_CASE("the sphere's radius moves every wall inwards") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[box_minimum_x_m] = -0.04f;
  set[box_maximum_z_m] = 0.03f;
  set[sphere_radius_m] = 0.005f;
  const Box smaller = control::prepare(set).box;
  CHECK(smaller.minimum_m.x == doctest::Approx(-0.035f));
  CHECK(smaller.maximum_m.z == doctest::Approx(0.025f));
}

}  // namespace
