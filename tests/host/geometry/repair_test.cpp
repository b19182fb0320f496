// Repairs and measurements of meshes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/geometry/examples.hpp"
#include "host/geometry/repair.hpp"
#include "tests/host/import/made_files.hpp"

using namespace inkwell;
using namespace inkwell::geometry;
using tests::Cube;
using tests::make_cube;

namespace {

/// Adds a copy of the cube. `is_inside_out`: with the opposite orientation.
void add_cube(Cube& cube, const glm::vec3& offset, float side, bool is_inside_out = false) {
  const auto first = static_cast<std::uint32_t>(cube.vertices.size());
  const Cube more = make_cube(side);
  for (const auto& vertex : more.vertices) cube.vertices.push_back(vertex + offset);
  for (auto face : more.faces) {
    if (is_inside_out) std::swap(face[1], face[2]);
    cube.faces.push_back({first + face[0], first + face[1], first + face[2]});
  }
}

struct Repaired {
  Mesh mesh;
  Report report;
};

Repaired repaired(const Cube& cube) {
  Repaired result{weld(cube.vertices, cube.faces), {}};
  result.report = repair(result.mesh);
  CHECK(is_valid(result.mesh));
  const Measurements again = measure(result.mesh);
  CHECK(again.volume_m3 == doctest::Approx(result.report.measurements.volume_m3));
  CHECK(again.triangles == result.report.measurements.triangles);
  CHECK(again.vertices == result.report.measurements.vertices);
  CHECK(again.closed_parts == result.report.measurements.closed_parts);
  return result;
}

Report report_on(const Cube& cube) { return repaired(cube).report; }

}  // namespace

TEST_CASE("a closed cube is measured and left alone") {
  const Cube cube = make_cube(2);
  const auto [mesh, report] = repaired(cube);
  const auto& [measured, repairs] = report;
  CHECK_FALSE(repairs.any());
  CHECK(std::ranges::equal(mesh.faces, weld(cube.vertices, cube.faces).faces));
  CHECK(measured.triangles == 12);
  CHECK(measured.vertices == 8);
  CHECK(measured.parts == 1);
  CHECK(measured.is_closed());
  CHECK(measured.volume_m3 == doctest::Approx(8));
  CHECK(measured.area_m2 == doctest::Approx(24));
  CHECK(measured.box.minimum_m == glm::vec3(0));
  CHECK(measured.box.maximum_m == glm::vec3(2));
}

TEST_CASE("the example bodies are closed and need no repair") {
  for (const Example& example : examples()) {
    CAPTURE(example.name);
    Mesh mesh = example.make();
    const Report report = repair(mesh);
    CHECK(report.measurements.is_closed());
    CHECK(report.measurements.volume_m3 > 0);
    CHECK(report.repairs.turned == 0);
    CHECK(report.repairs.turned_parts == 0);
    CHECK(report.repairs.duplicates == 0);
  }
}

TEST_CASE("flipped triangles are turned, one by one or by part") {
  for (std::size_t face = 0; face < 12; ++face) {
    Cube cube = make_cube();
    std::swap(cube.faces[face][0], cube.faces[face][1]);
    const Report report = report_on(cube);
    CHECK(report.repairs.turned == 1);
    CHECK(report.repairs.turned_parts == 0);
    CHECK(report.measurements.is_closed());
    CHECK(report.measurements.volume_m3 == doctest::Approx(1));
  }
  Cube inside_out;
  add_cube(inside_out, {0, 0, 0}, 1, true);
  add_cube(inside_out, {3, 0, 0}, 1);
  const Report report = report_on(inside_out);
  CHECK(report.repairs.turned == 0);
  CHECK(report.repairs.turned_parts == 1);
  CHECK(report.measurements.parts == 2);
  CHECK(report.measurements.volume_m3 == doctest::Approx(2));
}

TEST_CASE("a cavity stays a cavity, also in a body that is inside out") {
  for (const bool is_inside_out : {false, true}) {
    Cube hollow;
    add_cube(hollow, {0, 0, 0}, 1, is_inside_out);
    add_cube(hollow, {0.25f, 0.25f, 0.25f}, 0.5f, !is_inside_out);
    const Report report = report_on(hollow);
    CHECK(report.measurements.volume_m3 == doctest::Approx(0.875));
    CHECK(report.repairs.turned_parts == (is_inside_out ? 2 : 0));
  }
  // The box of this small cube is inside the box of the large part, but the small cube is outside the large part.
  Cube corner;
  add_cube(corner, {0, 0, 0}, 1);
  corner.vertices[7] = {0.2f, 0.2f, 0.2f};
  add_cube(corner, {0.8f, 0.8f, 0.8f}, 0.1f, true);
  const Report report = report_on(corner);
  CHECK(report.repairs.turned_parts == 1);
  CHECK(report.measurements.closed_parts == 2);
}

TEST_CASE("degenerate and duplicate triangles are removed") {
  Cube cube = make_cube();
  cube.faces.push_back({1, 1, 2});
  cube.faces.push_back(cube.faces[5]);
  cube.faces.push_back({cube.faces[7][1], cube.faces[7][2], cube.faces[7][0]});
  const Report report = report_on(cube);
  CHECK(report.repairs.degenerate == 1);
  CHECK(report.repairs.duplicates == 2);
  CHECK(report.measurements.triangles == 12);
  CHECK(report.measurements.is_closed());
}

TEST_CASE("a body with two sides of each face, or written twice, becomes one closed body") {
  for (const bool is_opposite : {false, true}) {
    Cube cube = make_cube();
    const auto faces = cube.faces;
    for (auto face : faces) {
      if (is_opposite) std::swap(face[0], face[1]);
      cube.faces.push_back(face);
    }
    const Report report = report_on(cube);
    CHECK(report.repairs.duplicates == 12);
    CHECK(report.measurements.triangles == 12);
    CHECK(report.measurements.is_closed());
    CHECK(report.measurements.volume_m3 == doctest::Approx(1));
  }
}

TEST_CASE("bodies that share a wall keep their faces") {
  Cube neighbors = make_cube();
  add_cube(neighbors, {1, 0, 0}, 1);
  const Report opposite = report_on(neighbors);
  CHECK_FALSE(opposite.repairs.any());
  CHECK(opposite.measurements.is_closed());
  CHECK(opposite.measurements.branched_edges == 5);
  CHECK(opposite.measurements.volume_m3 == doctest::Approx(2));

  // A pyramid inside the cube, with the same floor in the same orientation.
  Cube stacked = make_cube();
  stacked.vertices.emplace_back(0.5f, 0.5f, 0.5f);
  for (const Face& face : {Face{0, 2, 3}, {0, 3, 1}, {0, 1, 8}, {1, 3, 8}, {3, 2, 8}, {2, 0, 8}})
    stacked.faces.push_back(face);
  const Report same = report_on(stacked);
  CHECK(same.repairs.duplicates == 0);
  CHECK(same.measurements.is_closed());
  CHECK(same.measurements.triangles == 18);
}

TEST_CASE("a needle on an edge is replaced, and the body remains closed") {
  for (const float offset : {0.0f, 1e-8f}) {
    Cube cube = make_cube();
    cube.vertices.emplace_back(offset, 0.5f, 0.0f);  // on the edge between the corners 0 and 2
    cube.faces.push_back({0, 8, 2});
    for (Face& face : cube.faces)
      if (face == Face{0, 6, 2}) face = {0, 6, 8};
    cube.faces.push_back({8, 6, 2});
    const Report report = report_on(cube);
    CHECK(report.repairs.needles == 1);
    CHECK(report.repairs.degenerate == 0);
    CHECK(report.measurements.is_closed());
    CHECK(report.measurements.triangles == 14);
    CHECK(report.measurements.volume_m3 == doctest::Approx(1));
  }
}

TEST_CASE("triangles without area at a border are removed") {
  const Report report = report_on({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
  CHECK(report.repairs.degenerate == 1);
  CHECK(report.measurements.triangles == 0);
  CHECK(report.measurements.vertices == 0);
  CHECK_FALSE(report.measurements.is_closed());
}

TEST_CASE("an open mesh and a surface without orientation are reported") {
  Cube open = make_cube();
  open.faces.pop_back();
  std::swap(open.faces[2][0], open.faces[2][1]);
  const Report report = report_on(open);
  CHECK_FALSE(report.measurements.is_closed());
  CHECK(report.measurements.open_edges == 3);
  CHECK(report.measurements.volume_m3 == 0);
  CHECK(report.repairs.turned == 1);

  // A Moebius strip.
  Cube strip;
  constexpr int sections = 12;
  for (int section = 0; section < sections; ++section) {
    const double turn_rad = 2 * std::numbers::pi * section / sections;
    for (const double side : {-0.2, 0.2}) {
      const double radius = 1 + side * std::cos(0.5 * turn_rad);
      strip.vertices.emplace_back(radius * std::cos(turn_rad), radius * std::sin(turn_rad),
                                  side * std::sin(0.5 * turn_rad));
    }
  }
  for (std::uint32_t section = 0; section < sections; ++section) {
    const bool is_last = section + 1 == sections;
    const std::uint32_t here = 2 * section, next = is_last ? 1 : here + 2, next_side = is_last ? 0 : here + 3;
    strip.faces.push_back({here, next, here + 1});
    strip.faces.push_back({here + 1, next, next_side});
  }
  const Report moebius = report_on(strip);
  CHECK_FALSE(moebius.measurements.is_closed());
  CHECK(moebius.measurements.flipped_edges > 0);
}

TEST_CASE("an empty mesh is neither closed nor repaired") {
  const Report report = report_on({});
  CHECK_FALSE(report.repairs.any());
  CHECK(report.measurements.parts == 0);
  CHECK_FALSE(report.measurements.is_closed());
}

TEST_CASE("the remaining triangles know their numbers before the repair") {
  Cube cube = make_cube();
  const auto faces = cube.faces;
  cube.faces.insert(cube.faces.begin(), {0, 0, 1});
  cube.faces.insert(cube.faces.begin() + 4, {faces[2][1], faces[2][2], faces[2][0]});  // a copy of triangle 2
  std::swap(cube.faces[6][0], cube.faces[6][1]);
  Mesh mesh = weld(cube.vertices, cube.faces);
  const Mesh welded = mesh;
  std::vector<std::uint32_t> sources;
  const Report report = repair(mesh, &sources);
  CHECK(report.repairs.degenerate == 1);
  CHECK(report.repairs.duplicates == 1);
  CHECK(report.repairs.turned == 1);
  REQUIRE(sources.size() == 12);
  for (std::size_t face = 0; face < 12; ++face) {
    Face now = mesh.faces[face], before = welded.faces[sources[face]];
    std::ranges::sort(now);
    std::ranges::sort(before);
    CHECK(now == before);
  }
}
