// Splits polygons into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/mesh.hpp"

namespace inkwell::importer {

/// The time grows with the square of the number of corners, so a polygon with more corners is refused.
inline constexpr std::size_t corners_max = 2048;

/// Splits a polygon by cutting ears, and appends the triangles. Concave polygons are correct if their edges do not
/// cross. Fewer than three corners result in no triangle. `corners`: indices of vertices, at most corners_max. Every
/// index must have a vertex.
void append_triangles(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> corners,
                      std::vector<geometry::Face>& faces);

}  // namespace inkwell::importer
