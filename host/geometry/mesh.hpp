// A body as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace inkwell::geometry {

/// Indices of the three corners, counter-clockwise as seen from outside.
using Face = std::array<std::uint32_t, 3>;

/// Triangles. After weld(), no two vertices have equal positions. Every index is below the count of vertices, and
/// every coordinate is finite: is_valid() checks both.
struct Mesh {
  std::vector<glm::vec3> vertices_m;
  std::vector<Face> faces;
};

/// Corners of an axis-aligned box. An empty box has a minimum above its maximum.
struct Box {
  glm::vec3 minimum_m{1e30f};
  glm::vec3 maximum_m{-1e30f};
};

/// Largest count of triangles that this library processes. Half-edge numbers (adjacency.hpp) need 32 bits.
inline constexpr std::size_t faces_max = 100'000'000;

bool is_valid(const Mesh& mesh);

Box bounding_box(const Mesh& mesh);

/// Cross product of two edges: the normal of the face times twice its area, in m2.
glm::vec3 area_normal_m2(const Mesh& mesh, const Face& face);

/// Joins vertices with exactly equal positions. The faces keep their number and order, so degenerate and duplicate
/// faces remain. Vertices without a face are removed. The indices must be valid.
Mesh weld(std::span<const glm::vec3> vertices_m, std::span<const Face> faces);

/// As above, for faces without indices, as in STL files: corners 3 n, 3 n + 1 and 3 n + 2 are face n.
Mesh weld(std::span<const glm::vec3> corners_m);

}  // namespace inkwell::geometry
