#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/touch.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::Contact;
using control::LocalModel;
using control::Shapes;
using control::Solid;
using control::Surface;
using control::Touch;
using control::TouchForce;
using control::Vector3;
using Core = Solid::Core;
using protocol::FeatureKind;

constexpr Surface smooth{.stiffness_N_per_m = 1000.0f,
                         .m_per_N = 1e-3f,
                         .damping_Ns_per_m = 0.0f,
                         .static_friction = 0.0f,
                         .dynamic_friction = 0.0f,
                         .viscosity_Ns_per_m = 0.0f};

constexpr control::ForceLimit no_limit{};

Surface rough(float static_friction, float dynamic_friction) {
  Surface surface = smooth;
  surface.static_friction = static_friction;
  surface.dynamic_friction = dynamic_friction;
  return surface;
}

Surface damped(float damping_Ns_per_m) {
  Surface surface = smooth;
  surface.damping_Ns_per_m = damping_Ns_per_m;
  return surface;
}

float length(const Vector3& vector) { return std::sqrt(control::dot(vector, vector)); }

void put_plane(Shapes& shapes, std::size_t number, const Vector3& normal, float offset_m, const Surface& surface) {
  shapes.planes[number] = {normal, offset_m};
  shapes.surfaces[number] = surface;
  shapes.life_periods[number] = Shapes::lasting;
}

void put_solid(Shapes& shapes, std::size_t number, const Solid& solid, const Surface& surface) {
  shapes.solids[number] = solid;
  shapes.surfaces[Shapes::planes_maximum + number] = surface;
  shapes.life_periods[Shapes::planes_maximum + number] = Shapes::lasting;
}

/// Touches shapes only.
struct Hand {
  Shapes shapes;
  Touch touch;
  Vector3 probe_m;

  void place() {
    find_tangents(shapes, probe_m);
    touch.shapes.replace(shapes);
  }
  Vector3 at(const Vector3& point_m, const Vector3& velocity_m_per_s = {}) {
    probe_m = point_m;
    return touch.step(probe_m, velocity_m_per_s, nullptr, smooth, no_limit).objects_N;
  }
  /// Moves the probe on a straight line in steps of at most 50 um, and returns the last force.
  Vector3 move_to(const Vector3& point_m) {
    const Vector3 way_m = point_m - probe_m, from_m = probe_m;
    const int steps = 1 + static_cast<int>(length(way_m) / 50e-6f);
    Vector3 force_N;
    for (int i = 1; i <= steps; ++i) force_N = at(from_m + (static_cast<float>(i) / static_cast<float>(steps)) * way_m);
    return force_N;
  }
};

constexpr Vector3 up{0.0f, 0.0f, 1.0f};

/// A box with its top at z = 0.
constexpr Solid table{.core = Core::box,
                      .centre_m = {0.0f, 0.0f, -0.01f},
                      .axes = {Vector3{1, 0, 0}, Vector3{0, 1, 0}, up},
                      .half_m = {0.05f, 0.05f, 0.0095f},
                      .radius_m = 5e-4f};

TEST_CASE("without objects there is no force, and the proxy is the probe") {
  Touch touch;
  CHECK(!touch.has_objects());
  const TouchForce force = touch.step({0.1f, -0.2f, -5.0f}, {1.0f, 1.0f, 1.0f}, nullptr, smooth, no_limit);
  CHECK(force.objects_N == Vector3{});
  CHECK(force.walls_N == Vector3{});
  CHECK(touch.proxy_m() == Vector3{0.1f, -0.2f, -5.0f});
}

TEST_CASE("the proxy is outside all barriers, also at small angles between the barriers") {
  struct Case {
    std::array<Vector3, 3> normals;
    std::array<float, 3> depth_m;
    std::size_t count;  // barriers that push
    float to_proxy_m;   // computed in double precision
  };
  const std::array cases{Case{{Vector3{0.960600674f, -0.194326162f, -0.198705018f},
                               {0.956782818f, -0.166951776f, -0.238104716f},
                               {0.951014638f, -0.236018524f, -0.199665695f}},
                              {4.6068551e-3f, 4.59455699e-3f, 4.6107918e-3f},
                              2,
                              4.6107967e-3f},
                         Case{{Vector3{-0.34722543f, 0.64742029f, 0.67844045f},
                               {-0.39004406f, 0.64507288f, 0.65707427f},
                               {-0.42116132f, 0.61323494f, 0.66825598f}},
                              {23.921e-3f, 23.952e-3f, 23.935e-3f},
                              3,
                              23.952686e-3f}};
  for (const Case& each : cases) {
    control::Barriers barriers;
    barriers.clear();
    for (std::size_t i = 0; i < 3; ++i) barriers.add(each.normals[i], each.depth_m[i], smooth, {});
    control::Support support;
    control::find_support(barriers, support);
    CHECK(support.count == each.count);
    CHECK(std::abs(length(support.out_m) - each.to_proxy_m) < 5e-7f);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(barriers.list[i].depth_m - control::dot(barriers.list[i].normal, support.out_m) < 1e-7f);
  }
}

TEST_CASE("a plane pushes along its normal with spring and damper, and never pulls") {
  Hand hand;
  put_plane(hand.shapes, 7, {0.6f, 0.0f, 0.8f}, 0.01f, damped(2.0f));
  hand.place();
  CHECK(hand.at({0.01f, 0.3f, 0.01f}) == Vector3{});  // 4 mm above the plane
  const Vector3 force_N = hand.at({0.0f, 0.3f, 0.0f}, {0.0f, 1.0f, -0.5f});
  const float expected_N = 1000.0f * 0.01f + 2.0f * 0.8f * 0.5f;
  CHECK(force_N.x == doctest::Approx(0.6f * expected_N));
  CHECK(force_N.y == 0.0f);
  CHECK(force_N.z == doctest::Approx(0.8f * expected_N));
  CHECK(hand.at({0.0f, 0.3f, 0.0f}, {0.0f, 0.0f, 30.0f}) == Vector3{});
}

TEST_CASE("every plane and every solid is felt") {
  for (std::size_t number = 0; number < Shapes::maximum; ++number) {
    CAPTURE(number);
    Hand hand;
    if (number < Shapes::planes_maximum)
      put_plane(hand.shapes, number, up, 0.0f, smooth);
    else
      put_solid(hand.shapes, number - Shapes::planes_maximum,
                {.core = Core::point, .centre_m = {0.0f, 0.0f, -0.01f}, .radius_m = 0.01f}, smooth);
    hand.place();
    CHECK(hand.at({0.0f, 0.0f, -0.001f}).z == doctest::Approx(1.0f));
  }
}

TEST_CASE("walls at right angles give the force of the paper, with damping, also at edges and corners") {
  tests::Random random{3};
  const control::Box box{{-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}};
  const Surface wall = damped(5.0f);
  for (int i = 0; i < 2000; ++i) {
    const auto coordinate_m = [&] { return random.between(-0.056f, 0.056f); };
    const Vector3 probe_m{coordinate_m(), coordinate_m(), coordinate_m()};
    const Vector3 velocity_m_per_s{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const Contact contact = find_contact(probe_m, box);
    const Vector3 paper_N = wall_force_N(contact, velocity_m_per_s, {1000.0f, 5.0f});
    Touch touch;
    const TouchForce force = touch.step(probe_m, velocity_m_per_s, &box, wall, no_limit);
    CHECK(length(force.walls_N - paper_N) < 1e-4f);
    CHECK(force.objects_N == Vector3{});
  }
}

TEST_CASE("two planes that meet at a flat angle are as hard below their edge as one plane") {
  for (const float angle_rad : {0.0f, 0.001f, 0.02f, 0.2f}) {
    CAPTURE(angle_rad);
    Hand hand;
    const float sine = std::sin(angle_rad), cosine = std::cos(angle_rad);
    put_plane(hand.shapes, 0, {sine, 0.0f, cosine}, 0.0f, damped(2.0f));
    put_plane(hand.shapes, 1, {-sine, 0.0f, cosine}, 0.0f, damped(2.0f));
    hand.place();
    const Vector3 force_N = hand.at({0.0f, 0.0f, -0.001f}, {0.0f, 0.0f, -0.1f});
    CHECK(force_N.z == doctest::Approx(1.2f).epsilon(0.05));
    CHECK(force_N.x == doctest::Approx(0.0f).scale(1).epsilon(0.03));
  }
}

TEST_CASE("the proxy is the nearest point of the intersection of up to three half-spaces") {
  tests::Random random{11};
  const auto direction = [&] {
    const Vector3 vector{random.between(-1, 1), random.between(-1, 1), random.between(0.2f, 1)};
    return (1.0f / length(vector)) * vector;
  };
  for (int i = 0; i < 500; ++i) {
    const Vector3 normals[3] = {direction(), direction(), direction()};
    Hand hand;
    for (std::size_t k = 0; k < 3; ++k) put_plane(hand.shapes, k, normals[k], 0.0f, smooth);
    hand.place();
    const Vector3 probe_m{random.between(-0.004f, 0.004f), random.between(-0.004f, 0.004f), -0.003f};
    hand.at(probe_m);  // the first period finds only the barriers that exclude the probe
    const Vector3 force_N = hand.at(probe_m);
    const Vector3 proxy_m = probe_m + 1e-3f * force_N;
    // The proxy is in the free space, and no free point near the proxy is nearer to the probe.
    for (const Vector3& normal : normals) CHECK(dot(normal, proxy_m) > -5e-6f);
    for (int k = 0; k < 40; ++k) {
      const Vector3 other_m = proxy_m + Vector3{random.between(-1e-3f, 1e-3f), random.between(-1e-3f, 1e-3f),
                                                random.between(-1e-3f, 1e-3f)};
      const bool is_free =
          std::ranges::all_of(normals, [&](const Vector3& normal) { return dot(normal, other_m) >= 0; });
      if (is_free) CHECK(length(other_m - probe_m) > length(proxy_m - probe_m) - 5e-6f);
    }
  }
}

TEST_CASE("a sphere pushes outward by its depth while the probe slides around it") {
  Hand hand;
  const Vector3 centre_m{0.01f, 0.02f, 0.03f};
  put_solid(hand.shapes, 0, {.core = Core::point, .centre_m = centre_m, .radius_m = 0.02f}, smooth);
  hand.place();
  hand.at(centre_m + Vector3{0.0f, 0.0f, 0.021f});
  for (int i = 0; i <= 2000; ++i) {
    const float angle_rad = 0.002f * static_cast<float>(i);
    const Vector3 out{std::sin(angle_rad), 0.0f, std::cos(angle_rad)};
    const Vector3 force_N = hand.at(centre_m + 0.018f * out);
    if (i < 5) continue;
    CHECK(length(force_N) == doctest::Approx(2.0f).epsilon(2e-3));
    CHECK(dot(force_N, out) == doctest::Approx(2.0f).epsilon(2e-3));
  }
}

TEST_CASE("a sphere among sixteen other solids in reach is felt as one sphere, at 0.5 m/s") {
  Hand hand;
  for (std::size_t i = 0; i < Shapes::solids_maximum; ++i)
    put_solid(hand.shapes, i, {.core = Core::point, .centre_m = {0.0f, i == 9 ? 0.0f : 0.1f, 0.0f}, .radius_m = 0.02f},
              smooth);
  hand.at({0.0f, 0.0f, 0.021f});
  hand.place();
  for (int i = 0; i <= 4000; ++i) {
    const float angle_rad = 1.25e-3f * static_cast<float>(i);
    const Vector3 out{std::sin(angle_rad), 0.0f, std::cos(angle_rad)};
    const Vector3 force_N = hand.at(0.018f * out);
    if (i < 20) continue;
    CHECK(length(force_N) == doctest::Approx(2.0f).epsilon(5e-3));
    CHECK(dot(force_N, out) == doctest::Approx(2.0f).epsilon(5e-3));
  }
}

TEST_CASE("objects that the hand passed while the force was off do not push") {
  Hand hand;
  put_solid(hand.shapes, 0, {.core = Core::point, .centre_m = {0.0f, 0.03f, 0.0f}, .radius_m = 0.005f}, smooth);
  put_solid(hand.shapes, 1, table, smooth);
  hand.at({0.0f, 0.03f, 0.006f});
  hand.place();
  hand.at({0.0f, 0.03f, 0.006f});
  for (int i = 0; i < 100; ++i) hand.touch.release({0.0f, 0.03f, -0.05f});
  for (int i = 0; i < 100; ++i) CHECK(hand.at({0.0f, 0.03f, -0.05f}) == Vector3{});
  CHECK(hand.touch.proxy_m().z == -0.05f);
}

TEST_CASE("a probe that slides off a soft object is caught by the object below") {
  Surface soft = smooth;
  soft.stiffness_N_per_m = 120.0f;
  soft.m_per_N = 1.0f / 120.0f;
  Surface hard = smooth;
  hard.stiffness_N_per_m = 3000.0f;
  hard.m_per_N = 1.0f / 3000.0f;
  const auto box = [](float x_m, float top_m, float half_height_m) {
    return Solid{.core = Core::box,
                 .centre_m = {x_m, 0.0f, top_m - half_height_m},
                 .axes = {Vector3{1, 0, 0}, Vector3{0, 1, 0}, up},
                 .half_m = {0.0295f, 0.0295f, half_height_m - 5e-4f},
                 .radius_m = 5e-4f};
  };
  Hand hand;
  put_solid(hand.shapes, 0, box(-0.03f, 0.017f, 0.008f), soft);
  put_solid(hand.shapes, 1, box(0.02f, 0.0f, 0.001f), hard);
  for (std::size_t i = 2; i < Shapes::solids_maximum; ++i)
    put_solid(hand.shapes, i, {.core = Core::point, .centre_m = {0.0f, 0.5f, 0.0f}, .radius_m = 0.01f}, smooth);
  hand.at({-0.01f, 0.0f, 0.02f});
  hand.place();
  hand.move_to({-0.01f, 0.0f, -0.0013f});
  hand.move_to({0.01f, 0.0f, -0.0013f});
  CHECK(hand.at(hand.probe_m).z == doctest::Approx(3.9f).epsilon(1e-2));
}

TEST_CASE("a probe between ten posts is pushed out of the table below") {
  Hand hand;
  for (std::size_t i = 0; i < 10; ++i) {
    const float angle_rad = 0.6283f * static_cast<float>(i);
    put_solid(hand.shapes, i,
              {.core = Core::segment,
               .centre_m = {0.0035f * std::cos(angle_rad), 0.0035f * std::sin(angle_rad), 0.0f},
               .axes = {up},
               .half_m = {0.02f},
               .radius_m = 0.001f},
              smooth);
  }
  put_solid(hand.shapes, 16, table, smooth);
  hand.at({0.0f, 0.0f, 0.001f});
  hand.place();
  hand.move_to({0.0f, 0.0f, -0.003f});
  for (int i = 0; i < 20; ++i) CHECK(hand.at(hand.probe_m).z == doctest::Approx(3.0f).epsilon(1e-2));
}

TEST_CASE("a probe at rest in a corner behind seven posts has a constant force") {
  Hand hand;
  for (std::size_t i = 0; i < 7; ++i)
    put_solid(hand.shapes, i,
              {.core = Core::segment,
               .centre_m = {-0.0018f, -0.0024f + 8e-4f * static_cast<float>(i), 0.0f},
               .axes = {up},
               .half_m = {0.02f},
               .radius_m = 3e-4f},
              smooth);
  Solid block = table;
  block.centre_m = {0.05f, 0.0f, 0.0f};
  block.half_m = {0.0495f, 0.05f, 0.0295f};
  put_solid(hand.shapes, 14, block, smooth);
  put_solid(hand.shapes, 15, table, smooth);
  hand.at({-0.001f, 0.0f, 0.002f});
  hand.place();
  hand.move_to({-0.001f, 0.0f, -0.002f});
  const Vector3 force_N = hand.move_to({0.0026f, 0.0f, -0.002f});
  CHECK(force_N.x == doctest::Approx(-2.6f).epsilon(2e-2));
  CHECK(force_N.z == doctest::Approx(2.0f).epsilon(2e-2));
  for (int i = 0; i < 100; ++i) CHECK(length(hand.at(hand.probe_m) - force_N) < 0.1f);
}

TEST_CASE("a probe that is pushed through the middle of a solid is still pushed back to its entry") {
  const Solid solids[] = {
      {.core = Core::point, .radius_m = 0.004f},
      {.core = Core::segment, .axes = {Vector3{1, 0, 0}}, .half_m = {0.02f}, .radius_m = 0.004f},
      {.core = Core::box,
       .axes = {Vector3{1, 0, 0}, Vector3{0, 1, 0}, up},
       .half_m = {0.02f, 0.02f, 1e-4f},
       .radius_m = 5e-4f},
      {.core = Core::cylinder, .axes = {up}, .half_m = {1e-4f}, .core_radius_m = 0.02f, .radius_m = 5e-4f}};
  for (const Solid& solid : solids) {
    CAPTURE(static_cast<int>(solid.core));
    Hand hand;
    put_solid(hand.shapes, 3, solid, smooth);
    hand.place();
    hand.at({0.0f, 0.0f, 0.006f});
    const float top_m = solid.radius_m + (solid.core == Core::box || solid.core == Core::cylinder ? 1e-4f : 0.0f);
    CHECK(hand.move_to({0.0f, 0.0f, -0.003f}).z == doctest::Approx(1000.0f * (top_m + 0.003f)).epsilon(1e-2));
    CHECK(hand.move_to({0.0f, 0.0f, 0.006f}) == Vector3{});
  }
}

TEST_CASE("friction sticks up to its static bound, then slides with the dynamic one, and sticks again") {
  Hand hand;
  put_plane(hand.shapes, 0, up, 0.0f, rough(0.8f, 0.5f));
  hand.place();
  const auto force_at = [&](float x_m) { return hand.at({x_m, 0, -0.001f}); };
  CHECK(force_at(0.0f).x == 0.0f);  // 1 N of normal force
  CHECK(force_at(0.0007f).x == doctest::Approx(-0.7f));
  CHECK(force_at(0.0009f).x == doctest::Approx(-0.5f));
  CHECK(hand.touch.slides());
  CHECK(force_at(0.0020f).x == doctest::Approx(-0.5f));
  CHECK(force_at(0.0021f).x == doctest::Approx(-0.5f));
  CHECK(force_at(0.0020f).x == doctest::Approx(-0.4f));  // reversed: static friction from the stopping point
  CHECK(!hand.touch.slides());
  CHECK(force_at(0.0012f).x == doctest::Approx(0.4f));
  CHECK(force_at(0.0012f).z == doctest::Approx(1.0f));
}

TEST_CASE("above the force limit, friction holds the proxy as at the limit, and the force keeps its direction") {
  Touch touch;
  Shapes shapes;
  put_plane(shapes, 0, up, 0.0f, rough(0.5f, 0.4f));
  find_tangents(shapes, {});
  touch.shapes.replace(shapes);
  constexpr control::ForceLimit limit{2.0f, 0.5f};
  constexpr float depth_m = 0.01f;  // 10 N
  Vector3 force_N;
  for (int i = 0; i <= 1000; ++i)
    force_N = touch.step({static_cast<float>(i) * 10e-6f, 0, -depth_m}, {}, nullptr, smooth, limit).objects_N;
  CHECK(touch.proxy_m().x == doctest::Approx(0.01f - 0.4f * 2.0f / 1000.0f));
  CHECK(force_N.z == doctest::Approx(10.0f));
  CHECK(force_N.x == doctest::Approx(-0.4f * 10.0f));
}

TEST_CASE("the friction ends where the probe leaves the surface, and starts where the probe touches it again") {
  Hand hand;
  put_plane(hand.shapes, 0, up, 0.0f, rough(1.0f, 1.0f));
  hand.place();
  hand.at({0.0f, 0.0f, -0.001f});
  CHECK(hand.at({0.0005f, 0.0f, -0.001f}).x == doctest::Approx(-0.5f));
  hand.at({0.0005f, 0.0f, 0.001f});
  CHECK(hand.at({0.0005f, 0.0f, -0.001f}).x == 0.0f);
}

TEST_CASE("a new touch sticks up to the static bound, also after a slide") {
  Hand hand;
  put_plane(hand.shapes, 0, up, 0.0f, rough(0.8f, 0.5f));
  hand.place();
  hand.at({0.0f, 0.0f, -0.001f});
  hand.at({0.002f, 0.0f, -0.001f});
  CHECK(hand.touch.slides());
  hand.at({0.002f, 0.0f, 0.001f});
  hand.at({0.002f, 0.0f, -0.001f});
  CHECK(hand.at({0.0027f, 0.0f, -0.001f}).x == doctest::Approx(-0.7f));
}

TEST_CASE("the first period of a touch has the force for the position of the probe") {
  Hand hand;
  put_solid(hand.shapes, 0, {.core = Core::point, .centre_m = {0.05f, 0.0f, 0.0f}, .radius_m = 0.02f}, smooth);
  hand.place();
  for (int i = 0; i < 60; ++i) hand.at({0.05f, 0.0f, 0.0215f});
  CHECK(hand.at({0.069f, 0.0f, 0.0f}).x == doctest::Approx(1.0f).epsilon(1e-3));
}

TEST_CASE("nearly parallel planes are as hard as one plane") {
  tests::Random random{23};
  for (int i = 0; i < 500; ++i) {
    const Vector3 vector{random.between(-1, 1), random.between(-1, 1), random.between(0.2f, 1)};
    const Vector3 normal = (1.0f / length(vector)) * vector;
    const Vector3 bent = normal + Vector3{random.between(-1e-6f, 1e-6f), random.between(-1e-6f, 1e-6f), 0.0f};
    Hand hand;
    put_plane(hand.shapes, 0, normal, 0.0f, smooth);
    put_plane(hand.shapes, 1, bent, random.between(-1e-7f, 1e-7f), smooth);
    put_plane(hand.shapes, 2, normal, 0.0f, smooth);
    hand.place();
    hand.at(-0.001f * normal);
    CHECK(length(hand.at(-0.001f * normal) - normal) < 5e-3f);
  }
}

TEST_CASE("the friction continues while the probe passes from one surface to the next") {
  Hand hand;
  put_plane(hand.shapes, 0, {0.05f, 0.0f, 0.99875f}, 0.0f, rough(0.5f, 0.5f));
  put_plane(hand.shapes, 1, {-0.05f, 0.0f, 0.99875f}, 0.0f, rough(0.5f, 0.5f));
  hand.place();
  hand.at({-0.01f, 0.0f, -0.001f});
  float least_N = 1.0f, most_N = 0.0f;
  for (int i = 0; i < 2000; ++i) {
    const float x_m = -0.005f + 5e-6f * static_cast<float>(i);
    const Vector3 force_N = hand.at({x_m, 0.0f, 0.05f * std::fabs(x_m) - 0.001f});
    if (i < 400) continue;
    least_N = std::min(least_N, -force_N.x);
    most_N = std::max(most_N, -force_N.x);
  }
  CHECK(least_N > 0.4f);
  CHECK(most_N < 0.65f);
}

TEST_CASE("viscosity acts along the surface and not more than the normal force") {
  Surface surface = smooth;
  surface.viscosity_Ns_per_m = 3.0f;
  Hand hand;
  put_plane(hand.shapes, 0, up, 0.0f, surface);
  hand.place();
  const Vector3 force_N = hand.at({0.0f, 0.0f, -0.001f}, {0.1f, 0.0f, -0.5f});
  CHECK(force_N.x == doctest::Approx(-0.3f));
  CHECK(force_N.z == doctest::Approx(1.0f));
  CHECK(hand.at({0.0f, 0.0f, -0.001f}, {2.0f, 0.0f, 0.0f}).x == doctest::Approx(-1.0f));
  CHECK(hand.at({0.0f, 0.0f, 0.001f}, {0.1f, 0.0f, 0.0f}) == Vector3{});
}

// ---- local models ----

control::Feature plane_feature(const Vector3& normal, float height_m, const Surface& surface) {
  control::Feature feature{};
  feature.centre_m = height_m * normal;
  feature.axis = normal;
  feature.surface = surface;
  return feature;
}

/// Activates a model whose tangent planes are at the proxy, and advances it by one period.
void follow(Touch& touch, LocalModel& model) {
  find_tangents(model, touch.proxy_m());
  touch.follow(model);
}

/// Runs a period without walls.
TouchForce step(Touch& touch, const Vector3& probe_m, const Vector3& velocity_m_per_s = {}) {
  touch.age();
  return touch.step(probe_m, velocity_m_per_s, nullptr, smooth, no_limit);
}

LocalModel model_of(std::initializer_list<control::Feature> features) {
  LocalModel model;
  std::ranges::copy(features, model.features.begin());
  model.count = features.size();
  model.life_periods = 5000;
  return model;
}

TEST_CASE("a surface that appears under the tip moves outward slowly, and its work is reported") {
  Touch touch;
  const Vector3 probe_m{0.0f, 0.0f, -0.001f};
  step(touch, probe_m);
  LocalModel model = model_of({plane_feature(up, 0.0f, smooth)});
  follow(touch, model);
  float force_N = 0.0f, work_J = 0.0f;
  for (int period = 0; period < 400; ++period) {
    const TouchForce force = step(touch, probe_m);
    CHECK(force.objects_N.z - force_N < 4.1e-3f);
    force_N = force.objects_N.z;
    work_J += force.raised_J;
    if (period == 100) CHECK(force_N == doctest::Approx(0.4f).epsilon(1e-2));
  }
  CHECK(force_N == doctest::Approx(1.0f).epsilon(1e-3));
  CHECK(work_J == doctest::Approx(0.5f * 1000.0f * 1e-6f).scale(0).epsilon(0.02));  // of the spring
}

TEST_CASE("two equal surfaces of any stiffness rise by at most 5 mN in a period, also in grooves of 16 degrees") {
  for (const float stiffness_N_per_m : {100.0f, 1000.0f, 3000.0f})
    for (const float lean : {0.0f, 0.5f, 0.866f, 0.99f}) {
      CAPTURE(stiffness_N_per_m);
      CAPTURE(lean);
      Surface surface = smooth;
      surface.stiffness_N_per_m = stiffness_N_per_m;
      surface.m_per_N = 1.0f / stiffness_N_per_m;
      const float height = std::sqrt(1.0f - lean * lean);
      Touch touch;
      const Vector3 probe_m{0.0f, 0.0f, -0.001f};
      step(touch, probe_m);
      LocalModel model =
          model_of({plane_feature({lean, 0, height}, 0, surface), plane_feature({-lean, 0, height}, 0, surface)});
      model.life_periods = 10000;
      follow(touch, model);
      float force_N = 0.0f;
      const float fastest_N = 1.01f * stiffness_N_per_m * control::largest_rise_m;
      for (int period = 0; period < 8000; ++period) {
        const TouchForce force = step(touch, probe_m);
        CHECK(force.objects_N.z - force_N < 5e-3f);
        if (lean == 0.0f) CHECK(force.objects_N.z - force_N < fastest_N);
        force_N = force.objects_N.z;
      }
      CHECK(force_N == doctest::Approx(1e-3f * stiffness_N_per_m).epsilon(1e-2));
    }
}

TEST_CASE("an exchange of local models under a pressing hand does not raise the force") {
  tests::Random random{17};
  const auto direction = [&] {
    const Vector3 vector{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    return (1.0f / length(vector)) * vector;
  };
  Touch touch;
  const Vector3 probe_m{0.001f, 0.002f, -0.003f};
  step(touch, probe_m);
  LocalModel models[2];
  float before_N = 0.0f, largest_N = 0.0f;
  for (int report = 0; report < 3000; ++report) {
    LocalModel& model = models[report % 2];
    model = {};
    model.life_periods = 5000;
    model.count = static_cast<std::size_t>(random.between(0, 3.99f));
    for (std::size_t i = 0; i < model.count; ++i) {
      control::Feature& feature = model.features[i];
      const float kind = random.between(0, 3);
      feature.surface = smooth;
      feature.kind = kind < 1 ? FeatureKind::plane : (kind < 2 ? FeatureKind::sphere : FeatureKind::cylinder);
      feature.centre_m = 0.004f * direction();
      const Vector3 axis = direction();
      if (feature.kind != FeatureKind::sphere) feature.axis = axis;
      feature.radius_m = kind < 1 ? 0.0f : random.between(0.0005f, 0.01f);
    }
    follow(touch, model);
    for (int period = 0; period < 20; ++period) {
      const float force_N = length(step(touch, probe_m).objects_N);
      if (period == 0) CHECK(force_N - before_N < 1e-3f);
      before_N = force_N;
      largest_N = std::max(largest_N, force_N);
    }
  }
  CHECK(largest_N > 0.5f);
}

TEST_CASE("friction holds the proxy on one surface of a groove, also while both surfaces are nearer to the probe") {
  constexpr float lean = 0.6f, height = 0.8f;
  Hand hand;
  put_plane(hand.shapes, 0, {lean, 0.0f, height}, 0.0f, rough(1.0f, 1.0f));
  put_plane(hand.shapes, 1, {-lean, 0.0f, height}, 0.0f, rough(1.0f, 1.0f));
  hand.place();
  hand.move_to({0.001f, 0.0f, 0.0007f});
  const Vector3 force_N = hand.move_to({0.0003f, 0.0f, -0.0006f});
  CHECK(!hand.touch.slides());
  for (int i = 0; i < 2000; ++i) CHECK(length(hand.at(hand.probe_m) - force_N) < 2e-3f);
}

TEST_CASE("a probe that enters five solids in the same period feels all of them after 3 ms") {
  Hand hand;
  for (std::size_t i = 0; i < 5; ++i) {
    Solid solid = table;
    solid.centre_m.z += 1e-4f * static_cast<float>(i);
    put_solid(hand.shapes, i, solid, smooth);
  }
  hand.at({0.0f, 0.0f, 0.002f});
  hand.place();
  for (int i = 0; i < 60; ++i) hand.at({0.0f, 0.0f, 0.0f});
  CHECK(hand.at(hand.probe_m).z == doctest::Approx(0.4f).epsilon(1e-2));
}

TEST_CASE("a moving surface carries the hand and its friction along at the servo rate") {
  Touch touch;
  const Vector3 start_m{0.0f, 0.0f, -0.0005f};
  Surface surface = rough(1.0f, 1.0f);
  surface.damping_Ns_per_m = 1.0f;
  LocalModel model = model_of({plane_feature(up, 0.0f, surface)});
  model.features[0].motion.velocity_m_per_s = {0.2f, 0.0f, 0.1f};
  step(touch, {0, 0, 0.001f});
  follow(touch, model);
  // The probe moves with the surface, so the force does not change.
  Vector3 force_N;
  for (int period = 1; period <= 400; ++period) {
    const float time_s = protocol::servo_period_s * static_cast<float>(period);
    force_N = step(touch, start_m + time_s * Vector3{0.2f, 0.0f, 0.1f}, {0.2f, 0.0f, 0.1f}).objects_N;
    if (period > 150) CHECK(force_N.z == doctest::Approx(0.5f).epsilon(1e-2));
    CHECK(std::fabs(force_N.x) < 1.1e-2f);  // the surface moves 10 um in a period
  }
  // The surface continues, and the probe stops: the surface pushes and pulls the probe along.
  const Vector3 stopped_m = start_m + 0.02f * Vector3{0.2f, 0.0f, 0.1f};
  for (int period = 1; period <= 40; ++period) force_N = step(touch, stopped_m).objects_N;
  CHECK(force_N.z == doctest::Approx(0.7f + 0.1f).epsilon(0.02));
  CHECK(force_N.x == doctest::Approx(0.4f + 0.2f).epsilon(0.05));
}

TEST_CASE("with friction, a probe in a corner of two surfaces stays out of both while models are exchanged") {
  Surface surface = rough(1.0f, 1.0f);
  surface.stiffness_N_per_m = 500.0f;
  surface.m_per_N = 1.0f / 500.0f;
  Touch touch;
  LocalModel models[2];
  Vector3 probe_m{0.01f, 0.0f, 0.001f}, force_N;
  for (int period = 0; period < 4000; ++period) {
    if (period % 20 == 0) {
      LocalModel& model = models[period / 20 % 2];
      model = model_of({plane_feature(up, 0.0f, surface), plane_feature({1, 0, 0}, 0.0f, surface)});
      follow(touch, model);
    }
    if (period < 400)
      probe_m.z -= 1.5e-5f;
    else if (period < 3400)
      probe_m.x -= 8.33e-6f;
    force_N = step(touch, probe_m).objects_N;
    CHECK(touch.proxy_m().x > -1e-5f);
    if (period > 100) CHECK(touch.proxy_m().z > -1e-5f);
  }
  CHECK(force_N.z > 2.0f);
  CHECK(force_N.x > 5.0f);
}

TEST_CASE("a probe that slides around a sphere, a cylinder and a plane of one model feels their radial depth") {
  Touch touch;
  control::Feature sphere = plane_feature({}, 0.0f, smooth);
  sphere.kind = FeatureKind::sphere;
  sphere.radius_m = 0.02f;
  control::Feature cylinder = plane_feature({0, 1, 0}, 0.0f, smooth);
  cylinder.kind = FeatureKind::cylinder;
  cylinder.radius_m = 0.02f;
  LocalModel model = model_of({sphere, cylinder, plane_feature(up, -0.5f, smooth)});
  step(touch, {0.0f, 0.0f, 0.021f});
  follow(touch, model);
  for (int i = 0; i <= 2000; ++i) {
    const float angle_rad = 1e-3f * static_cast<float>(i);
    const Vector3 out{std::sin(angle_rad), 0.0f, std::cos(angle_rad)};
    const Vector3 force_N = step(touch, 0.018f * out).objects_N;
    if (i < 400) continue;
    CHECK(length(force_N) == doctest::Approx(2.0f).epsilon(5e-3));
    CHECK(dot(force_N, out) == doctest::Approx(2.0f).epsilon(5e-3));
  }
}

TEST_CASE("a local model expires after its life") {
  Touch touch;
  LocalModel model = model_of({plane_feature(up, 0.0f, smooth)});
  model.life_periods = 20;
  follow(touch, model);
  CHECK(touch.has_objects());
  for (int period = 0; period < 20; ++period) CHECK(!touch.age());
  CHECK(touch.age());
  CHECK(!touch.has_objects());
  CHECK(!touch.age());
}

TEST_CASE("walls and objects share one proxy") {
  const control::Box box{{-0.05f, -0.05f, 0.0f}, {0.05f, 0.05f, 0.05f}};
  Hand hand;
  put_plane(hand.shapes, 0, up, 0.0f, smooth);  // in the wall
  hand.place();
  const Vector3 probe_m{0.0f, 0.0f, -0.001f};
  const TouchForce force = hand.touch.step(probe_m, {}, &box, smooth, no_limit);
  CHECK((force.walls_N + force.objects_N).z == doctest::Approx(1.0f).epsilon(1e-3));
}

}  // namespace
