// A mesh prepared for contact: neighbors and search tree.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/adjacency.hpp"
#include "host/geometry/mesh.hpp"
#include "host/geometry/tree.hpp"
#include "host/geometry/triangle.hpp"

namespace inkwell::geometry {

/// Point of a surface.
struct SurfacePoint {
  std::uint32_t face;
  glm::dvec3 point_m;
  Region region;
  double distance_m;
};

/// A mesh that does not change. Its coordinates are relative to the middle of its bounding box, because floats
/// are most precise near 0. Several threads can use a surface at the same time.
class Surface {
 public:
  /// Prepares a valid, welded mesh (Mesh). Returns nullptr if `progress` canceled the work. `sources`: for each face,
  /// the number that original_face() returns. By default, the number in `mesh`.
  static std::shared_ptr<const Surface> build(Mesh mesh, const Progress& progress = {},
                                              std::span<const std::uint32_t> sources = {});

  /// The faces are in the order of the tree.
  const Mesh& mesh() const { return mesh_; }
  const Adjacency& adjacency() const { return adjacency_; }
  const Tree& tree() const { return tree_; }
  /// Middle of the bounding box in the coordinates of the source mesh.
  const glm::dvec3& middle_m() const { return middle_m_; }
  /// Half the diagonal of the bounding box: no point is farther from the middle.
  float radius_m() const { return radius_m_; }
  /// Number of a face in the source mesh.
  std::uint32_t original_face(std::uint32_t face) const { return original_faces_[face]; }
  /// True if the mesh is closed, all faces have one orientation, and the volume is positive. Another mesh is a
  /// two-sided sheet.
  bool is_solid() const { return is_solid_; }
  double volume_m3() const { return volume_m3_; }

  Triangle triangle(std::uint32_t face) const {
    const Face& corners = mesh_.faces[face];
    return {mesh_.vertices_m[corners[0]], mesh_.vertices_m[corners[1]], mesh_.vertices_m[corners[2]]};
  }

  /// Closest point within `radius_m`. The search starts with the face `start`, which saves time if this face is near.
  std::optional<SurfacePoint> closest(const glm::dvec3& point_m, double radius_m, std::uint32_t start = 0) const;

  /// First face that the segment from `from_m` to `to_m` crosses. Faces are wider than their edges by 1e-6 of their
  /// size, so a segment cannot pass between two faces. `distance_m` is measured from `from_m`.
  std::optional<SurfacePoint> first_hit(const glm::dvec3& from_m, const glm::dvec3& to_m) const;

  /// True if the point is in the solid. Always false for a sheet. The sign of the angle-weighted normal at the closest
  /// point decides (Baerentzen and Aanaes, 2005).
  bool contains(const glm::dvec3& point_m) const;

  /// Normal at a point of a face: weighted by the angles of the faces at the same edge or vertex. Faces beyond an edge
  /// with a larger angle than `crease_rad` are omitted. Zero if the faces have no area.
  glm::dvec3 feature_normal(std::uint32_t face, Region region, double crease_rad = 4) const;

  /// Normal interpolated between the normals of the three corners. `crease_rad`: as in feature_normal().
  glm::dvec3 smooth_normal(std::uint32_t face, const glm::dvec3& point_m, double crease_rad) const;

  /// Calls `visit(face)` for all faces with this corner that edges connect to the face, including the face.
  /// Stops if `visit` returns false, or after 256 faces.
  template <class Visit>
  void visit_corner(std::uint32_t face, unsigned corner, const Visit& visit) const;

  /// Bytes of memory: mesh, neighbors and tree.
  std::size_t memory_bytes() const;

 private:
  Surface() = default;

  Mesh mesh_;
  Adjacency adjacency_;
  Tree tree_;
  std::vector<std::uint32_t> original_faces_;
  glm::dvec3 middle_m_{};
  float radius_m_ = 0;
  double volume_m3_ = 0;
  bool is_solid_ = false;
};

/// Number of the corner of the face with this vertex. The face must have the vertex.
inline unsigned corner_with(const Face& face, std::uint32_t vertex) {
  return face[0] == vertex ? 0u : face[1] == vertex ? 1u : 2u;
}

template <class Visit>
void Surface::visit_corner(std::uint32_t face, unsigned corner, const Visit& visit) const {
  constexpr unsigned count_max = 256;
  const std::uint32_t vertex = mesh_.faces[face][corner];
  if (!visit(face)) return;
  unsigned visited = 1;
  // Both edges at the corner: the walk around the vertex starts with the first edge. The second edge is needed only if
  // the first walk ends at a border.
  for (const unsigned first_edge : {corner, (corner + 2) % 3}) {
    std::uint32_t current = face;
    unsigned edge = first_edge;
    while (visited < count_max) {
      const HalfEdge neighbor = adjacency_.neighbors[current][edge];
      if (!is_face_edge(neighbor)) break;
      current = neighbor / 3;
      if (current == face) return;
      if (!visit(current)) return;
      ++visited;
      // The other edge of the neighbor at the same vertex.
      const unsigned at = corner_with(mesh_.faces[current], vertex);
      edge = neighbor % 3 == at ? (at + 2) % 3 : at;
    }
  }
}

}  // namespace inkwell::geometry
