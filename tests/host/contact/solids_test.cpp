#include "host/contact/solids.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/host/contact/hand.hpp"

namespace inkwell::contact {
namespace {

using Kind = SolidPoint::Kind;

void check(const Shape& shape, const glm::dvec3& point_m, double distance_m, const glm::dvec3& normal, Kind kind) {
  const SolidPoint point = closest_point_of_solid(shape, point_m);
  CHECK(point.distance_m == doctest::Approx(distance_m));
  CHECK(glm::distance(point.normal, normal) < 1e-9);
  CHECK(point.kind == kind);
  CHECK(glm::distance(point.point_m + point.normal * point.distance_m, point_m) < 1e-12);
}

}  // namespace

TEST_CASE("distances, normals and kinds of all solids, outside and inside") {
  const double diagonal = std::sqrt(0.5);
  check(Sphere{2}, {0, 3, 0}, 1, {0, 1, 0}, Kind::sphere);
  check(Sphere{2}, {0, 1, 0}, -1, {0, 1, 0}, Kind::sphere);
  check(Sphere{2}, {0, 0, 0}, -2, {0, 0, 1}, Kind::sphere);
  check(Box{{1, 2, 3}}, {1.5, 1, 1}, 0.5, {1, 0, 0}, Kind::plane);
  check(Box{{1, 2, 3}}, {-2, 1, 4}, std::sqrt(2), {-diagonal, 0, diagonal}, Kind::cylinder);
  check(Box{{1, 2, 3}}, {2, 3, 4}, std::sqrt(3), glm::dvec3{std::sqrt(1.0 / 3)}, Kind::sphere);
  check(Box{{1, 2, 3}}, {-0.8, 0, 0}, -0.2, {-1, 0, 0}, Kind::plane);
  check(Cylinder{1, 2}, {0, 3, 1}, 2, {0, 1, 0}, Kind::cylinder);
  check(Cylinder{1, 2}, {0.5, 0, -3}, 1, {0, 0, -1}, Kind::plane);
  check(Cylinder{1, 2}, {0, 2, 3}, std::sqrt(2), {0, diagonal, diagonal}, Kind::cylinder);
  check(Cylinder{1, 2}, {0, 0.9, 0}, -0.1, {0, 1, 0}, Kind::cylinder);
  check(Cylinder{1, 2}, {0, 0, 1.9}, -0.1, {0, 0, 1}, Kind::plane);
  check(Capsule{1, 2}, {0, 3, 1}, 2, {0, 1, 0}, Kind::cylinder);
  check(Capsule{1, 2}, {0, 0, 5}, 2, {0, 0, 1}, Kind::sphere);
  check(Capsule{1, 2}, {0, 0, 0}, -1, {1, 0, 0}, Kind::cylinder);
  check(Plane{}, {4, 5, 2}, 2, {0, 0, 1}, Kind::plane);
  check(Plane{}, {4, 5, -2}, -2, {0, 0, 1}, Kind::plane);
  CHECK(closest_point_of_solid(Cylinder{1, 2}, {0, 2, 3}).axis == glm::dvec3{-1, 0, 0});
}

TEST_CASE("the tip passes no solid at 2 m/s, and slides around each solid") {
  for (const Shape& shape : {Shape{Sphere{0.01}}, Shape{Box{{0.01, 0.01, 0.0001}}}, Shape{Cylinder{0.01, 0.0001}},
                             Shape{Capsule{0.001, 0.01}}, Shape{Plane{}}}) {
    Hand hand(scene_with(shape), 0.0005, {0.0013, 0.002, 0.02});
    for (int count = 0; count < 60; ++count) {
      hand.go(hand.pose.position_m - glm::dvec3{0, 0, 0.0006});
      CHECK(closest_point_of_solid(shape, hand.last.proxy_m).distance_m > 0.0005);
    }
    // The hand is below all solids. The tip has slid around the round ones.
    const bool is_round = std::holds_alternative<Sphere>(shape) || std::holds_alternative<Capsule>(shape);
    CHECK((glm::length(hand.stretch_m()) < 0.001) == is_round);
  }
}

TEST_CASE("solids send their own curvature, and very large ones their tangent plane") {
  Hand ball(scene_with(Sphere{0.03}), 0.001, {0, 0, 0.032});
  REQUIRE(ball.last.model.count == 1);
  CHECK(ball.last.model.features[0].kind == Feature::Kind::sphere);
  CHECK(ball.last.model.features[0].radius_m == doctest::Approx(0.031));
  CHECK(glm::length(ball.last.model.features[0].point_m) < 1e-6f);
  Hand rod(scene_with(Cylinder{0.03, 0.05}), 0.001, {0, 0.032, 0.01});
  REQUIRE(rod.last.model.count == 1);
  CHECK(rod.last.model.features[0].kind == Feature::Kind::cylinder);
  CHECK(rod.last.model.features[0].direction == glm::vec3{0, 0, 1});
  Hand planet(scene_with(Sphere{0.2}), 0.001, {0, 0, 0.202});
  REQUIRE(planet.last.model.count == 1);
  CHECK(planet.last.model.features[0].kind == Feature::Kind::plane);
  CHECK(planet.last.model.features[0].point_m.z == doctest::Approx(0.201));
}

}  // namespace inkwell::contact
