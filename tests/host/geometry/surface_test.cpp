#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <glm/geometric.hpp>

#include "host/geometry/examples.hpp"
#include "host/geometry/surface.hpp"

namespace inkwell::geometry {
namespace {

std::shared_ptr<const Surface> surface_of(const Mesh& mesh) {
  return Surface::build(weld(mesh.vertices_m, mesh.faces));
}

/// Repeatable random points in a cube.
class Points {
 public:
  glm::dvec3 next(double size_m) { return glm::dvec3{coordinate(), coordinate(), coordinate()} * size_m; }

 private:
  double coordinate() { return static_cast<double>(random_()) / 2147483647.5 - 1; }
  std::mt19937 random_{7};
};

double brute_distance_m(const Surface& surface, const glm::dvec3& point_m) {
  double least_m = 1e9;
  for (std::uint32_t face = 0; face < surface.mesh().faces.size(); ++face)
    least_m = std::min(least_m, glm::distance(closest_point(point_m, surface.triangle(face)).point_m, point_m));
  return least_m;
}

}  // namespace

TEST_CASE("the closest point of a triangle is in the right region, also of a triangle without area") {
  const Triangle triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK(closest_point({0.2, 0.3, 1}, triangle).region == Region::face);
  CHECK(closest_point({-1, -1, 0}, triangle).region == Region::corner_0);
  CHECK(closest_point({2, -0.5, 0}, triangle).region == Region::corner_1);
  CHECK(closest_point({-0.5, 2, 0}, triangle).region == Region::corner_2);
  CHECK(closest_point({0.5, -1, 0}, triangle).region == Region::edge_0);
  CHECK(closest_point({1, 1, 0}, triangle).region == Region::edge_1);
  CHECK(closest_point({-1, 0.5, 0}, triangle).region == Region::edge_2);
  for (const Triangle& flat : {Triangle{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, Triangle{{1, 0, 0}, {2, 0, 0}, {0, 0, 0}},
                               Triangle{{0, 0, 0}, {2, 0, 0}, {2, 0, 0}}, Triangle{{2, 0, 0}, {0, 0, 0}, {0, 0, 0}}})
    CHECK(glm::distance(closest_point({1.4, 1, 0}, flat).point_m, glm::dvec3{1.4, 0, 0}) < 1e-12);
  const Triangle point{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  CHECK(closest_point({5, 0, 0}, point).point_m == glm::dvec3{1, 1, 1});
}

TEST_CASE("the tree finds the same closest point as a search of all faces") {
  for (const char* const name : {"ball", "stairs", "star", "torus"}) {
    CAPTURE(name);
    const auto example = std::ranges::find(examples(), name, &Example::name);
    const auto surface = surface_of(std::string_view{name} == "ball" ? make_ball(0.035, 0.0015, 3) : example->make());
    Points points;
    for (int trial = 0; trial < 200; ++trial) {
      const glm::dvec3 point_m = points.next(0.06);
      const auto found = surface->closest(point_m, 1, static_cast<std::uint32_t>(trial) % 20);
      REQUIRE(found);
      const double expected_m = brute_distance_m(*surface, point_m);
      CHECK(std::abs(found->distance_m - expected_m) < 1e-9);
      CHECK(std::abs(glm::distance(point_m, found->point_m) - expected_m) < 1e-9);
      CHECK(!surface->closest(point_m, expected_m * 0.999));
    }
  }
}

TEST_CASE("a segment through a vertex or an edge does not pass the mesh") {
  const auto surface = surface_of(make_ball(0.03, 0.001, 3));
  const Mesh& mesh = surface->mesh();
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    const Triangle triangle = surface->triangle(face);
    for (const glm::dvec3& target_m :
         {triangle.a_m, (triangle.a_m + triangle.b_m) * 0.5, (triangle.b_m + triangle.c_m) * 0.5}) {
      const auto hit = surface->first_hit(target_m * 1.5, {});
      REQUIRE(hit);
      CHECK(glm::distance(hit->point_m, target_m) < 1e-7);
      CHECK(std::abs(hit->distance_m - glm::length(target_m) * 0.5) < 1e-7);
    }
  }
  CHECK(!surface->first_hit({0.05, 0.05, 0}, {0.05, -0.05, 0}));
}

TEST_CASE("only a closed mesh with outward faces is a solid, and it contains its inside") {
  Mesh mesh = make_box({0.02, 0.02, 0.0002});
  const auto plate = surface_of(mesh);
  CHECK(plate->is_solid());
  CHECK(plate->volume_m3() == doctest::Approx(8e-8));
  Points points;
  for (int trial = 0; trial < 1000; ++trial) {
    const glm::dvec3 point_m = points.next(0.012) * glm::dvec3{1, 1, 0.02};
    const bool is_inside = std::abs(point_m.x) < 0.01 && std::abs(point_m.y) < 0.01 && std::abs(point_m.z) < 0.0001;
    CHECK(plate->contains(point_m) == is_inside);
  }
  for (Face& face : mesh.faces) std::swap(face[0], face[1]);
  CHECK(!surface_of(mesh)->is_solid());
  for (Face& face : mesh.faces) std::swap(face[0], face[1]);
  std::swap(mesh.faces[0][0], mesh.faces[0][1]);
  CHECK(!surface_of(mesh)->is_solid());
  mesh.faces.pop_back();
  const auto open = surface_of(mesh);
  CHECK(!open->is_solid());
  CHECK(!open->contains({}));
}

TEST_CASE("the cones of normals omit no face with a local minimum of the distance") {
  const auto surface = surface_of(make_ball(0.03, 0.003, 4));
  Points points;
  std::size_t visited = 0;
  std::size_t minima = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const glm::dvec3 point_m = points.next(0.04);
    std::set<std::uint32_t> faces;
    surface->tree().visit_facing(glm::vec3{point_m}, 0.02f, false, [&](std::uint32_t face) { faces.insert(face); });
    visited += faces.size();
    for (std::uint32_t face = 0; face < surface->mesh().faces.size(); ++face) {
      const Triangle triangle = surface->triangle(face);
      const ClosestPoint closest = closest_point(point_m, triangle);
      const glm::dvec3 way_m = point_m - closest.point_m;
      const bool is_in_front = glm::dot(way_m, surface->feature_normal(face, Region::face)) > 0;
      if (closest.region != Region::face || !is_in_front || glm::length(way_m) > 0.0199) continue;
      ++minima;
      CHECK(faces.contains(face));
    }
  }
  CHECK(minima > 50);
  CHECK(visited < 300 * surface->mesh().faces.size() / 10);
}

TEST_CASE("mesh, neighbors and tree have at most 100 bytes per triangle") {
  const auto surface = surface_of(make_ball(0.03, 0.001, 6));
  CHECK(surface->memory_bytes() <= 100 * surface->mesh().faces.size());
}

TEST_CASE("a mesh far from the origin is moved to its middle, and the faces keep their numbers") {
  Mesh mesh = make_box({0.02, 0.03, 0.04});
  for (glm::vec3& vertex_m : mesh.vertices_m) vertex_m += glm::vec3{4, -8, 16};
  const auto surface = surface_of(mesh);
  CHECK(glm::distance(surface->middle_m(), glm::dvec3{4, -8, 16}) < 1e-6);
  CHECK(surface->radius_m() == doctest::Approx(0.02693).epsilon(0.001));
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    const Face& original = mesh.faces[surface->original_face(face)];
    const glm::dvec3 corner_m = surface->middle_m() + surface->triangle(face).a_m;
    CHECK(glm::distance(corner_m, glm::dvec3{mesh.vertices_m[original[0]]}) < 1e-6);
  }
}

TEST_CASE("building reports increasing progress, and can be canceled at each report") {
  std::vector<double> fractions;
  const Mesh mesh = make_ball(0.03, 0, 5);
  CHECK(Surface::build(mesh, [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  }));
  CHECK(std::ranges::is_sorted(fractions));
  CHECK(fractions.front() == 0);
  CHECK(fractions.back() == 1);
  for (std::size_t limit = 0; limit < fractions.size(); ++limit) {
    std::size_t count = 0;
    CHECK(!Surface::build(mesh, [&](double) { return count++ < limit; }));
  }
}

TEST_CASE("meshes without faces, with one vertex in all faces and with equal faces are built") {
  CHECK(Surface::build({})->closest({}, 1) == std::nullopt);
  const Mesh dot{{{1, 1, 1}}, {{0, 0, 0}, {0, 0, 0}}};
  CHECK(Surface::build(dot)->closest({0, 0, 1}, 10)->distance_m == doctest::Approx(1));
  Mesh equal{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
  equal.faces.resize(1000, {0, 1, 2});
  CHECK(Surface::build(equal)->closest({-0.3, -0.3, 1}, 10)->distance_m == doctest::Approx(1));
}

TEST_CASE("a smooth normal follows the sphere, and stops at creases") {
  const auto ball = surface_of(make_ball(0.02, 0, 3));
  for (std::uint32_t face = 0; face < ball->mesh().faces.size(); ++face) {
    const Triangle triangle = ball->triangle(face);
    const glm::dvec3 point_m = triangle.a_m * 0.5 + triangle.b_m * 0.3 + triangle.c_m * 0.2;
    CHECK(glm::dot(ball->smooth_normal(face, point_m, 0.6), glm::normalize(point_m)) > std::cos(0.01));
  }
  const auto box = surface_of(make_box({0.02, 0.02, 0.02}));
  for (std::uint32_t face = 0; face < box->mesh().faces.size(); ++face) {
    const glm::dvec3 normal = box->smooth_normal(face, box->triangle(face).a_m, 0.6);
    CHECK(glm::dot(normal, box->feature_normal(face, Region::face)) == doctest::Approx(1));
  }
}

}  // namespace inkwell::geometry
