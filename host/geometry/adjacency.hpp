// Neighbors of the triangles of a welded mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/geometry/mesh.hpp"

namespace inkwell::geometry {

/// Number of a half-edge: three times the face plus the corner at which the edge starts. Half-edge 0 of a face leads
/// from its corner 0 to its corner 1.
using HalfEdge = std::uint32_t;

/// An edge with one face.
inline constexpr HalfEdge boundary = 0xFFFFFFFF;
/// An edge with three or more faces, or an edge of a face that has the same vertex twice.
inline constexpr HalfEdge branched = 0xFFFFFFFE;

/// For each half-edge of each face the half-edge of the neighbor face, or `boundary` or `branched`. Two faces with
/// opposite orientations are neighbors too: their half-edges start at the same vertex (is_flipped()).
struct Adjacency {
  std::vector<std::array<HalfEdge, 3>> neighbors;

  HalfEdge across(HalfEdge edge) const { return neighbors[edge / 3][edge % 3]; }
};

constexpr bool is_face_edge(HalfEdge edge) { return edge < branched; }

/// The mesh must be welded: faces are neighbors if they share the indices of two vertices.
Adjacency find_neighbors(const Mesh& mesh);

/// True if the half-edge and its neighbor have the same direction: one of both faces has the wrong orientation.
bool is_flipped(const Mesh& mesh, const Adjacency& adjacency, HalfEdge edge);

/// True if each edge has exactly two faces. Only a closed mesh without flipped edges encloses a volume.
bool is_closed(const Adjacency& adjacency);

}  // namespace inkwell::geometry
