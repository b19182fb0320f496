#include <doctest/doctest.h>

#include <cmath>

#include "firmware/control/signal_path/shapes.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::Grip;
using control::Shapes;
using control::Surface;
using control::TouchedShapes;
using control::Vector3;

constexpr Surface smooth{.stiffness_N_per_m = 1000.0f,
                         .m_per_N = 1e-3f,
                         .damping_Ns_per_m = 2.0f,
                         .static_friction = 0.0f,
                         .dynamic_friction = 0.0f};

Surface rough(float static_friction, float dynamic_friction) {
  Surface surface = smooth;
  surface.damping_Ns_per_m = 0.0f;
  surface.static_friction = static_friction;
  surface.dynamic_friction = dynamic_friction;
  return surface;
}

constexpr std::uint32_t for_long = 1'000'000;

/// Places a floor at height `z_m`.
void put_floor(Shapes& shapes, std::size_t index, float z_m, const Surface& surface,
               std::uint32_t life_periods = for_long) {
  shapes.planes[index] = {{0.0f, 0.0f, 1.0f}, z_m};
  shapes.surfaces[1 + index] = surface;
  shapes.life_periods[1 + index] = life_periods;
}

void put_ball(Shapes& shapes, const Vector3& centre_m, float radius_m, const Surface& surface) {
  shapes.sphere = {centre_m, radius_m, radius_m * radius_m};
  shapes.surfaces[0] = surface;
  shapes.life_periods[0] = for_long;
}

float length(const Vector3& vector) { return std::sqrt(control::dot(vector, vector)); }

TEST_CASE("without shapes there is no force") {
  TouchedShapes touched;
  CHECK(!touched.any());
  CHECK(!touched.age());
  CHECK(touched.force_N({0.1f, -0.2f, -5.0f}, {1.0f, 1.0f, 1.0f}) == Vector3{});
}

TEST_CASE("a plane pushes along its normal with spring and damper, and never pulls") {
  Shapes shapes;
  shapes.planes[7] = {{0.6f, 0.0f, 0.8f}, 0.01f};
  shapes.surfaces[8] = smooth;
  shapes.life_periods[8] = for_long;
  TouchedShapes touched;
  touched.replace(shapes);
  CHECK(touched.any());
  CHECK(touched.force_N({0.01f, 0.3f, 0.01f}, {}) == Vector3{});  // 4 mm above the plane
  const Vector3 force_N = touched.force_N({0.0f, 0.3f, 0.0f}, {0.0f, 1.0f, -0.5f});
  const float expected_N = 1000.0f * 0.01f + 2.0f * 0.8f * 0.5f;
  CHECK(force_N.x == doctest::Approx(0.6f * expected_N));
  CHECK(force_N.y == 0.0f);
  CHECK(force_N.z == doctest::Approx(0.8f * expected_N));
  CHECK(touched.force_N({0.0f, 0.3f, 0.0f}, {0.0f, 0.0f, 30.0f}) == Vector3{});
}

TEST_CASE("every one of eight planes and the sphere is felt") {
  for (std::size_t index = 0; index < protocol::shape_planes_maximum; ++index) {
    Shapes shapes;
    put_floor(shapes, index, 0.0f, smooth);
    TouchedShapes touched;
    touched.replace(shapes);
    CHECK(touched.force_N({0.0f, 0.0f, -0.001f}, {}).z == doctest::Approx(1.0f));
  }
  Shapes shapes;
  for (std::size_t index = 0; index < protocol::shape_planes_maximum; ++index) put_floor(shapes, index, 0.0f, smooth);
  put_ball(shapes, {0.0f, 0.0f, -0.01f}, 0.01f, smooth);
  TouchedShapes touched;
  touched.replace(shapes);
  CHECK(touched.force_N({0.0f, 0.0f, -0.001f}, {}).z == doctest::Approx(9.0f));
}

TEST_CASE("a ball pushes outwards by its depth, and at its centre not at all") {
  Shapes shapes;
  put_ball(shapes, {0.01f, 0.02f, 0.03f}, 0.02f, smooth);
  TouchedShapes touched;
  touched.replace(shapes);
  tests::Random random{5};
  for (int i = 0; i < 500; ++i) {
    Vector3 out_m{random.between(-0.02f, 0.02f), random.between(-0.02f, 0.02f), random.between(-0.02f, 0.02f)};
    const float distance_m = length(out_m);
    const Vector3 force_N = touched.force_N(shapes.sphere.centre_m + out_m, {});
    if (distance_m >= 0.02f) {
      CHECK(force_N == Vector3{});
      continue;
    }
    CHECK(length(force_N) == doctest::Approx(1000.0f * (0.02f - distance_m)).scale(0).epsilon(1e-3));
    CHECK(control::dot(force_N, out_m) == doctest::Approx(length(force_N) * distance_m).scale(0).epsilon(1e-3));
  }
  CHECK(touched.force_N(shapes.sphere.centre_m, {}) == Vector3{});
}

TEST_CASE("friction sticks up to its static bound, then slides with the dynamic one, and sticks again") {
  const Surface surface = rough(0.8f, 0.5f);
  const Vector3 up{0.0f, 0.0f, 1.0f};
  Grip grip;
  const auto force_at = [&](float x_m, bool is_new = false) {
    return control::surface_force_N(surface, up, 0.001f, {x_m, 0, 0}, {}, grip, is_new);
  };
  CHECK(force_at(0.0f, true).x == 0.0f);  // 1 N of normal force
  CHECK(force_at(0.0007f).x == doctest::Approx(-0.7f));
  CHECK(force_at(0.0009f).x == doctest::Approx(-0.5f));
  CHECK(grip.slides);
  CHECK(force_at(0.0020f).x == doctest::Approx(-0.5f));
  CHECK(force_at(0.0021f).x == doctest::Approx(-0.5f));
  CHECK(force_at(0.0020f).x == doctest::Approx(-0.4f));  // reversed: static friction from the stopping point
  CHECK(!grip.slides);
  CHECK(force_at(0.0012f).x == doctest::Approx(0.4f));
  CHECK(force_at(0.0012f).z == doctest::Approx(1.0f));
}

TEST_CASE("the friction of a plane ends where the probe leaves it, and starts where the probe touches it again") {
  Shapes shapes;
  put_floor(shapes, 0, 0.0f, rough(1.0f, 1.0f));
  TouchedShapes touched;
  touched.replace(shapes);
  touched.force_N({0.0f, 0.0f, -0.001f}, {});
  CHECK(touched.force_N({0.0005f, 0.0f, -0.001f}, {}).x == doctest::Approx(-0.5f));
  touched.force_N({0.0005f, 0.0f, 0.001f}, {});
  CHECK(touched.force_N({0.0005f, 0.0f, -0.001f}, {}).x == 0.0f);
  SUBCASE("the same plane in a new set keeps its grip") {
    Shapes next = shapes;
    next.planes[0].offset_m = 0.0001f;
    touched.replace(next);
    CHECK(touched.force_N({0.0007f, 0.0f, -0.001f}, {}).x == doctest::Approx(-0.2f));
  }
  SUBCASE("one whose life has ended in between does not") {
    Shapes short_lived = shapes;
    short_lived.life_periods[1] = 1;
    touched.replace(short_lived);
    CHECK(touched.age());
    touched.replace(shapes);
    CHECK(touched.force_N({0.0007f, 0.0f, -0.001f}, {}).x == 0.0f);
  }
  SUBCASE("a plane that was away in between does not") {
    const Shapes nothing;
    touched.replace(nothing);
    CHECK(!touched.any());
    touched.replace(shapes);
    CHECK(touched.force_N({0.0007f, 0.0f, -0.001f}, {}).x == 0.0f);
  }
}

TEST_CASE("each shape ends after its life, and the end is reported once") {
  Shapes shapes;
  put_floor(shapes, 0, 0.0f, smooth, 3);
  put_floor(shapes, 4, 0.0f, smooth, 5);
  TouchedShapes touched;
  touched.replace(shapes);
  float felt_N[8]{};
  bool ended[8]{};
  for (int period = 0; period < 8; ++period) {
    ended[period] = touched.age();
    felt_N[period] = touched.force_N({0.0f, 0.0f, -0.001f}, {}).z;
  }
  for (int period = 0; period < 8; ++period) {
    CAPTURE(period);
    CHECK(ended[period] == (period == 2 || period == 4));
    CHECK(felt_N[period] == doctest::Approx(period < 2 ? 2.0f : (period < 4 ? 1.0f : 0.0f)));
  }
  CHECK(!touched.any());
}

}  // namespace
