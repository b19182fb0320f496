#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "firmware/control/signal_path/shapes.hpp"

namespace {

using namespace inkwell;
using control::LivingShapes;
using control::Shapes;
using control::Solid;
using control::Vector3;

constexpr float margin_m = control::near_margin_m(0.0f);
constexpr std::size_t first_solid = Shapes::planes_maximum;

/// Adds spheres of 10 mm at the origin.
void put_spheres(Shapes& shapes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    shapes.solids[i] = {
        .core = Solid::Core::point, .centre_m = {}, .axes = {}, .half_m = {}, .core_radius_m = 0.0f, .radius_m = 0.01f};
    shapes.life_periods[first_solid + i] = Shapes::lasting;
  }
}

TEST_CASE("without shapes nothing lives") {
  LivingShapes living;
  CHECK(!living.any());
  CHECK(living.near() == 0);
  CHECK(!living.age());
  living.examine({}, margin_m);
}

TEST_CASE("each shape ends at most 25 periods after its life, and the end is reported once") {
  Shapes shapes;
  put_spheres(shapes, 3);
  constexpr std::array<std::uint32_t, 3> lives{30, 50, 2000};
  constexpr std::array<std::size_t, 3> numbers{0, 4, first_solid + 2};
  for (std::size_t i = 0; i < numbers.size(); ++i) shapes.life_periods[numbers[i]] = lives[i];
  find_tangents(shapes, {0, 0, 0.012f});
  LivingShapes living;
  living.replace(shapes);
  int ends = 0;
  for (std::uint32_t period = 1; period < 3000; ++period) {
    CAPTURE(period);
    ends += living.age();
    living.examine({0, 0, 0.012f}, margin_m);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const bool lives_on = (living.near() >> numbers[i] & 1u) != 0;
      if (period < lives[i]) CHECK(lives_on);
      if (period >= lives[i] + Shapes::maximum) CHECK(!lives_on);
    }
  }
  CHECK(ends == 3);
  CHECK(living.near() == 3u << first_solid);  // two spheres last
  Shapes nothing;
  find_tangents(nothing, {});
  living.replace(nothing);
  CHECK(!living.any());
  CHECK(living.near() == 0);
}

TEST_CASE("the tangent planes of seventeen solids are renewed in 34 periods, in turn with the other shapes") {
  Shapes shapes;
  put_spheres(shapes, Shapes::solids_maximum);
  find_tangents(shapes, {0, 0, 0.012f});
  LivingShapes living;
  living.replace(shapes);
  const auto renewed = [&](const Vector3& normal) {
    const auto begin = shapes.planes.begin() + first_solid;
    return std::count_if(begin, shapes.planes.end(),
                         [&](const auto& plane) { return plane.normal.x > 0.9f * normal.x; });
  };
  for (int period = 1; period <= 34; ++period) {
    living.examine({0.012f, 0, 0}, margin_m);
    CHECK(renewed({1, 0, 0}) == (period + 1) / 2);
  }
}

TEST_CASE("a shape is near while the proxy is within the margin of its surface") {
  Shapes shapes;
  put_spheres(shapes, 1);
  shapes.planes[0] = {{0, 0, 1}, 0.1f};
  shapes.life_periods[0] = Shapes::lasting;
  LivingShapes living;
  const auto near_at = [&](const Vector3& proxy_m) {
    for (int period = 0; period < 4; ++period) living.examine(proxy_m, margin_m);
    return living.near();
  };
  find_tangents(shapes, {0, 0, 0.2f});
  living.replace(shapes);
  CHECK(living.any());
  CHECK(living.near() == 0);
  CHECK(near_at({0, 0.0159f, 0.2f}) == 0);
  CHECK(near_at({0, 0, 0.1059f}) == 1u);
  CHECK(near_at({0, 0.0159f, 0}) == (1u << first_solid | 1u));
  CHECK(living.plane(first_solid).normal.y == doctest::Approx(1.0f));
  CHECK(living.plane(first_solid).offset_m == doctest::Approx(0.01f));
  CHECK(near_at({0, 0.0161f, 0}) == 1u);
  CHECK(near_at({0, 0, 0.1061f}) == 0);
  CHECK(near_at({}) == 1u);  // in the core, a solid has no tangent plane
}

TEST_CASE("a far shape is found in 50 periods, while a near solid is renewed in every second period") {
  Shapes shapes;
  put_spheres(shapes, Shapes::solids_maximum);
  for (std::size_t i = 1; i < Shapes::solids_maximum; ++i) shapes.solids[i].centre_m = {0, 0, 0.5f};
  for (std::size_t i = 0; i < Shapes::planes_maximum; ++i) {
    shapes.planes[i] = {{0, 0, 1}, -1.0f};
    shapes.life_periods[i] = Shapes::lasting;
  }
  find_tangents(shapes, {0, 0.012f, 0});
  LivingShapes living;
  living.replace(shapes);
  shapes.solids[16].centre_m = {};
  for (int period = 1; period <= 50; ++period) {
    const bool is_even = period % 4 < 2;
    living.examine(is_even ? Vector3{0, 0.012f, 0} : Vector3{0.012f, 0, 0}, margin_m);
    if ((living.near() >> (first_solid + 16) & 1u) != 0) break;
    if (period % 2 == 1) CHECK(living.plane(first_solid).normal.y == doctest::Approx(is_even ? 1.0f : 0.0f));
  }
  CHECK(living.near() == (1u << first_solid | 1u << (first_solid + 16)));
}

}  // namespace
