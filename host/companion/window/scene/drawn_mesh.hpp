// The triangles of an object as the scene draws them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"

namespace inkwell::window {

/// An object with more triangles is drawn as a copy with at most this count.
inline constexpr std::size_t drawn_triangles_max = 40'000;
/// The shadow has at most this count of triangles.
inline constexpr std::size_t shadow_triangles_max = 4'000;
/// Two faces that meet at a larger angle have a visible edge between them.
inline constexpr float crease_rad = 0.6f;

struct DrawnVertex {
  glm::vec3 position_m;
  glm::vec3 normal;  ///< unit vector
};

/// All positions are in mesh axes.
struct DrawnMesh {
  std::vector<DrawnVertex> vertices;
  std::vector<std::uint32_t> indices;         ///< three for each triangle
  std::vector<std::uint32_t> shadow_indices;  ///< of fewer triangles, whose normals are not valid
  geometry::Box box;
  bool is_solid = false;      ///< the original faces enclose a volume, so their rear sides are not visible
  bool is_decimated = false;  ///< `indices` are not the original faces, and some can be flipped
};

/// Prepares a mesh for drawing, in about a second for a million triangles. An invalid mesh has no drawn triangles.
DrawnMesh make_drawn_mesh(const geometry::Mesh& mesh);

}  // namespace inkwell::window
