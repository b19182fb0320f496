#include <doctest/doctest.h>

#include <array>
#include <limits>

#include "host/geometry/adjacency.hpp"
#include "host/geometry/examples.hpp"
#include "host/geometry/mesh.hpp"

namespace inkwell::geometry {
namespace {

/// Two triangles that share the edge from (1, 0) to (0, 1), as in an STL file.
std::vector<glm::vec3> square_corners() { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}; }

}  // namespace

TEST_CASE("welding joins exactly equal positions, also 0 and -0, and keeps the faces") {
  auto corners_m = square_corners();
  corners_m[3].y = -0.0f;
  const Mesh mesh = weld(corners_m);
  CHECK(mesh.vertices_m.size() == 4);
  REQUIRE(mesh.faces.size() == 2);
  CHECK(mesh.faces[0][1] == mesh.faces[1][0]);
  corners_m[3].x += 1e-6f;
  CHECK(weld(corners_m).vertices_m.size() == 5);
}

TEST_CASE("welding indexed faces removes unused vertices and keeps degenerate faces") {
  const std::vector<glm::vec3> vertices_m{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  const std::vector<Face> faces{{1, 2, 3}, {4, 2, 3}};
  const Mesh mesh = weld(vertices_m, faces);
  CHECK(mesh.vertices_m.size() == 3);
  REQUIRE(mesh.faces.size() == 2);
  CHECK(mesh.faces[1][0] == mesh.faces[1][1]);
}

TEST_CASE("a mesh with wrong indices or infinite coordinates is not valid") {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  CHECK(is_valid(mesh));
  mesh.faces[0][2] = 3;
  CHECK(!is_valid(mesh));
  mesh.faces[0][2] = 2;
  mesh.vertices_m[1].y = std::numeric_limits<float>::quiet_NaN();
  CHECK(!is_valid(mesh));
}

TEST_CASE("neighbors are found over the edges, and borders are marked") {
  const Mesh mesh = weld(square_corners());
  const Adjacency adjacency = find_neighbors(mesh);
  CHECK(adjacency.neighbors[0] == std::array<HalfEdge, 3>{boundary, 5, boundary});
  CHECK(adjacency.neighbors[1] == std::array<HalfEdge, 3>{boundary, boundary, 1});
  CHECK(!is_closed(adjacency));
  CHECK(!is_flipped(mesh, adjacency, 1));
}

TEST_CASE("faces with opposite orientations are neighbors over a flipped edge") {
  Mesh mesh = weld(square_corners());
  std::swap(mesh.faces[1][0], mesh.faces[1][1]);
  const Adjacency adjacency = find_neighbors(mesh);
  CHECK(is_face_edge(adjacency.across(1)));
  CHECK(is_flipped(mesh, adjacency, 1));
}

TEST_CASE("an edge of three faces and an edge with one vertex are branched") {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 2, 3}}};
  const Adjacency adjacency = find_neighbors(mesh);
  for (std::size_t face = 0; face < 3; ++face) CHECK(adjacency.neighbors[face][0] == branched);
  CHECK(adjacency.neighbors[3][0] == branched);
}

TEST_CASE("every example is closed, has its middle at the origin and fits into the workspace of the arm") {
  for (const Example& example : examples()) {
    CAPTURE(example.name);
    const Mesh mesh = example.make();
    CHECK(is_valid(mesh));
    CHECK(weld(mesh.vertices_m, mesh.faces).vertices_m.size() == mesh.vertices_m.size());
    CHECK(is_closed(find_neighbors(mesh)));
    const Box box = bounding_box(mesh);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(box.minimum_m[axis] > -0.05f);
      CHECK(box.maximum_m[axis] < 0.05f);
      CHECK(std::abs(box.minimum_m[axis] + box.maximum_m[axis]) < 0.02f);
    }
  }
}

}  // namespace inkwell::geometry
