// Checks counts, normals, creases and shadows of the drawn triangles.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <glm/glm.hpp>

#include "host/companion/window/scene/drawn_mesh.hpp"
#include "host/geometry/examples.hpp"

using namespace inkwell;
using window::DrawnMesh;
using window::make_drawn_mesh;

namespace {

/// Largest distance of the drawn vertices from a sphere around the origin.
float farthest_from_sphere_m(const DrawnMesh& drawn, float radius_m) {
  float farthest_m = 0.0f;
  for (const window::DrawnVertex& vertex : drawn.vertices)
    farthest_m = std::max(farthest_m, std::abs(glm::length(vertex.position_m) - radius_m));
  return farthest_m;
}

}  // namespace

TEST_CASE("a small mesh is drawn with all its triangles, and a ball is smooth") {
  const geometry::Mesh ball = geometry::make_ball(0.03, 0.0, 3);
  const DrawnMesh drawn = make_drawn_mesh(ball);
  CHECK(drawn.indices.size() == 3 * ball.faces.size());
  CHECK(drawn.vertices.size() == ball.vertices_m.size());  // without a crease
  CHECK(drawn.is_solid);
  for (const window::DrawnVertex& vertex : drawn.vertices)
    REQUIRE(glm::dot(vertex.normal, glm::normalize(vertex.position_m)) > 0.999f);
  CHECK(drawn.box.maximum_m.x == doctest::Approx(0.03).epsilon(0.02));
}

TEST_CASE("the edges of a box are creases with a normal for each face") {
  const DrawnMesh drawn = make_drawn_mesh(geometry::make_box({0.02, 0.03, 0.04}));
  CHECK(drawn.vertices.size() == 24);
  for (const window::DrawnVertex& vertex : drawn.vertices) {
    const glm::vec3 size = glm::abs(vertex.normal);
    REQUIRE(std::max({size.x, size.y, size.z}) == doctest::Approx(1.0));
    REQUIRE(glm::dot(vertex.normal, vertex.position_m) > 0.0f);  // outward
  }
}

TEST_CASE("each drawn triangle keeps its orientation") {
  const DrawnMesh drawn = make_drawn_mesh(geometry::make_ball(0.03, 0.0, 3));
  for (std::size_t i = 0; i < drawn.indices.size(); i += 3) {
    const glm::vec3 a = drawn.vertices[drawn.indices[i]].position_m;
    const glm::vec3 b = drawn.vertices[drawn.indices[i + 1]].position_m;
    const glm::vec3 c = drawn.vertices[drawn.indices[i + 2]].position_m;
    REQUIRE(glm::dot(glm::cross(b - a, c - a), a) > 0.0f);
  }
}

TEST_CASE("a large mesh is drawn as a decimated copy of the same shape") {
  const geometry::Mesh ball = geometry::make_ball(0.04, 0.0, 7);
  REQUIRE(ball.faces.size() == 327'680);
  const DrawnMesh drawn = make_drawn_mesh(ball);
  const std::size_t triangles = drawn.indices.size() / 3;
  CHECK(triangles <= window::drawn_triangles_max);
  CHECK(triangles > window::drawn_triangles_max * 9 / 10);
  CHECK(drawn.is_solid);
  CHECK(farthest_from_sphere_m(drawn, 0.04f) < 5e-5f);
  for (const window::DrawnVertex& vertex : drawn.vertices)  // also of small faces that decimation has folded
    REQUIRE(glm::dot(vertex.normal, glm::normalize(vertex.position_m)) > 0.999f);
}

TEST_CASE("the shadow has few triangles between vertices of the drawn mesh") {
  const DrawnMesh drawn = make_drawn_mesh(geometry::make_ball(0.04, 0.0, 5));
  CHECK(drawn.indices.size() / 3 == 20'480);
  CHECK(drawn.shadow_indices.size() / 3 <= window::shadow_triangles_max);
  CHECK(drawn.shadow_indices.size() / 3 > window::shadow_triangles_max / 2);
  for (const std::uint32_t index : drawn.shadow_indices) REQUIRE(index < drawn.vertices.size());
}

TEST_CASE("a mesh of many separate triangles is decimated too") {
  geometry::Mesh grass;
  for (std::uint32_t i = 0; i < 60'000; ++i) {
    const glm::vec3 root_m{1e-3f * static_cast<float>(i % 245), 0.0f, 1e-3f * static_cast<float>(i / 245)};
    for (const glm::vec3& tip_m : {glm::vec3{0.0f}, glm::vec3{3e-4f, 0.0f, 0.0f}, glm::vec3{0.0f, 2e-3f, 0.0f}})
      grass.vertices_m.push_back(root_m + tip_m);
    grass.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const DrawnMesh drawn = make_drawn_mesh(grass);
  CHECK(drawn.indices.size() / 3 <= window::drawn_triangles_max);
  CHECK(drawn.indices.size() / 3 > 1000);
  CHECK_FALSE(drawn.is_solid);
}

TEST_CASE("an open or inverted mesh is not solid, because its rear sides are visible") {
  geometry::Mesh box = geometry::make_box({0.02, 0.03, 0.04});
  for (geometry::Face& face : box.faces) std::swap(face[0], face[1]);
  CHECK_FALSE(make_drawn_mesh(box).is_solid);
  geometry::Mesh open = geometry::make_box({0.02, 0.03, 0.04});
  open.faces.pop_back();
  CHECK_FALSE(make_drawn_mesh(open).is_solid);
}

TEST_CASE("faces whose corners are not welded are drawn smooth") {
  const geometry::Mesh ball = geometry::make_ball(0.03, 0.0, 3);
  geometry::Mesh corners;
  for (const geometry::Face& face : ball.faces) {
    const auto first = static_cast<std::uint32_t>(corners.vertices_m.size());
    for (const std::uint32_t index : face) corners.vertices_m.push_back(ball.vertices_m[index]);
    corners.faces.push_back({first, first + 1, first + 2});
  }
  CHECK(make_drawn_mesh(corners).vertices.size() == ball.vertices_m.size());
}

TEST_CASE("an invalid mesh has no drawn triangles") {
  CHECK(make_drawn_mesh({}).indices.empty());
  CHECK(make_drawn_mesh({.vertices_m = {{0, 0, 0}, {1, 0, 0}}, .faces = {{0, 1, 2}}}).indices.empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(make_drawn_mesh({.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, .faces = {{0, 1, 2}}}).indices.empty());
}

TEST_CASE("a triangle without area has a valid normal") {
  const DrawnMesh drawn = make_drawn_mesh({.vertices_m = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .faces = {{0, 1, 2}}});
  for (const window::DrawnVertex& vertex : drawn.vertices) CHECK(glm::length(vertex.normal) == doctest::Approx(1.0));
}
