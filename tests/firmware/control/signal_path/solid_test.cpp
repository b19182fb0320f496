#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/solid.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::Foot;
using control::Solid;
using control::Vector3;
using Core = Solid::Core;

float length(const Vector3& vector) { return std::sqrt(control::dot(vector, vector)); }

constexpr std::array<Vector3, 3> turned{Vector3{0.6f, 0.8f, 0.0f}, Vector3{-0.8f, 0.6f, 0.0f}, Vector3{0, 0, 1}};

const Solid solids[] = {
    {.core = Core::point, .centre_m = {0.01f, 0, 0}, .radius_m = 0.02f},
    {.core = Core::segment, .axes = turned, .half_m = {0.03f}, .radius_m = 0.01f},
    {.core = Core::cylinder, .axes = turned, .half_m = {0.02f}, .core_radius_m = 0.015f, .radius_m = 0.0005f},
    {.core = Core::box, .axes = turned, .half_m = {0.01f, 0.02f, 0.03f}, .radius_m = 0.0005f},
};

TEST_CASE("a foot is the nearest point of the surface, and its normal points from there to the point") {
  tests::Random random{7};
  for (const Solid& solid : solids) {
    CAPTURE(static_cast<int>(solid.core));
    for (int i = 0; i < 300; ++i) {
      const Vector3 point_m{random.between(-0.08f, 0.08f), random.between(-0.08f, 0.08f),
                            random.between(-0.08f, 0.08f)};
      Foot foot;
      if (!find_foot(solid, point_m, foot)) continue;
      CHECK(length(foot.normal) == doctest::Approx(1.0f).epsilon(1e-5));
      if (foot.height_m < 0.0f) continue;
      // The foot is on the surface, and the height falls by the step towards the foot.
      Foot there;
      REQUIRE(find_foot(solid, point_m - foot.height_m * foot.normal, there));
      CHECK(std::fabs(there.height_m) < 2e-7f);
      CHECK(dot(there.normal, foot.normal) == doctest::Approx(1.0f).epsilon(1e-4));
    }
  }
}

TEST_CASE("heights above the sides, the edges and the ends of the solids") {
  const auto height_m = [](const Solid& solid, const Vector3& point_m) {
    Foot foot;
    REQUIRE(find_foot(solid, point_m, foot));
    return foot.height_m;
  };
  const auto at = [](float along, float across, float up) {
    return along * turned[0] + across * turned[1] + up * turned[2];
  };
  const auto near = [](float expected_m) { return doctest::Approx(expected_m).scale(0).epsilon(1e-4); };
  CHECK(height_m(solids[0], {0.01f, 0.05f, 0}) == near(0.03f));
  CHECK(height_m(solids[1], at(0.02f, 0.04f, 0)) == near(0.03f));
  CHECK(height_m(solids[1], at(0.05f, 0, 0)) == near(0.01f));
  CHECK(height_m(solids[2], at(0.01f, 0.0f, 0.0255f)) == near(0.01f));
  CHECK(height_m(solids[2], at(0.0305f, 0.01f, 0)) == near(0.01f));
  CHECK(height_m(solids[2], at(0.023f, 0.019f, 0)) == near(0.0045f));
  CHECK(height_m(solids[3], at(0, 0.0305f, 0)) == near(0.01f));
  CHECK(height_m(solids[3], at(0.013f, 0.024f, 0)) == near(0.0045f));
}

TEST_CASE("a tangent plane touches the solid at the foot of the point, and a far point gives none") {
  const Solid& sphere = solids[0];
  control::Plane tangent;
  REQUIRE(find_tangent(sphere, {0.01f, 0.0229f, 0}, 0.003f, tangent));
  CHECK(tangent.normal.y == doctest::Approx(1.0f));
  CHECK(tangent.offset_m == doctest::Approx(0.02f));
  CHECK(!find_tangent(sphere, {0.01f, 0.0231f, 0}, 0.003f, tangent));
  CHECK(!find_tangent(sphere, sphere.centre_m, 0.003f, tangent));
}

TEST_CASE("in its core a solid has no normal") {
  Foot foot;
  CHECK(!find_foot(solids[0], solids[0].centre_m, foot));
  for (const Solid& solid : {solids[1], solids[2], solids[3]})
    CHECK(!find_foot(solid, {0.001f, 0.001f, 0}, foot) == (solid.core != Core::segment));
}

}  // namespace
