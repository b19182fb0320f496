// Parts of a mesh and their edges, for measurements and repairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "host/geometry/adjacency.hpp"
#include "host/geometry/mesh.hpp"

namespace inkwell::geometry {

/// Triangles that are connected by edges, and their edges.
struct Topology {
  std::vector<std::uint32_t> part_of_face;
  std::vector<bool> is_closed;  ///< of each part
  std::size_t open_edges = 0;
  std::size_t branched_edges = 0;
  std::size_t flipped_edges = 0;
};

/// A half-edge between two vertices that three or more faces share.
struct BranchedEdge {
  std::pair<std::uint32_t, std::uint32_t> vertices;  ///< lower index first
  HalfEdge edge;
  bool is_forward;  ///< from the lower to the higher vertex
};

/// Sorted by vertices.
std::vector<BranchedEdge> find_branched_edges(const Mesh& mesh, const Adjacency& adjacency);

Topology find_topology(const Mesh& mesh, const Adjacency& adjacency);

/// Signed volume between a face and the origin, in m3. The sum over a closed part is its volume.
double signed_volume_m3(const Mesh& mesh, const Face& face);

/// Solid angle of a face, seen from a point, over the full solid angle. The sum over a closed part is 1 inside it and 0
/// outside.
double winding_share(const Mesh& mesh, const Face& face, const glm::vec3& point_m);

}  // namespace inkwell::geometry
