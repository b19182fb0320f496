#include "host/companion/window/scene/drawn_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <meshoptimizer.h>
#include <glm/glm.hpp>

#include "host/geometry/adjacency.hpp"
#include "host/geometry/topology.hpp"

namespace inkwell::window {

namespace {

constexpr float any_error = 1.0f;                      // relative to the size of the mesh
constexpr std::size_t simplified_faces_max = 400'000;  // larger meshes would take several seconds
constexpr float tiny_share = 0.1f;                     // of the largest surface at a vertex
constexpr std::uint32_t none = 0xFFFFFFFF;

std::span<const std::uint32_t> indices_of(const std::vector<geometry::Face>& faces) {
  static_assert(sizeof(geometry::Face) == 3 * sizeof(std::uint32_t));
  return {faces.empty() ? nullptr : faces.front().data(), 3 * faces.size()};
}

/// Merges neighbor vertices, also of different parts. Fast, but moves edges.
std::vector<geometry::Face> merged_faces(const std::vector<glm::vec3>& vertices_m,
                                         const std::vector<geometry::Face>& faces, std::size_t faces_max) {
  const std::span<const std::uint32_t> indices = indices_of(faces);
  std::vector<geometry::Face> fewer(faces.size());
  fewer.resize(meshopt_simplifySloppy(fewer.front().data(), indices.data(), indices.size(), &vertices_m.front().x,
                                      vertices_m.size(), sizeof(glm::vec3), 3 * faces_max, any_error, nullptr) /
               3);
  return fewer;
}

/// Removes the edges with the smallest effect on the shape. Retains parts and holes, so the result may have too many
/// faces.
std::vector<geometry::Face> simplified_faces(const std::vector<glm::vec3>& vertices_m,
                                             const std::vector<geometry::Face>& faces, std::size_t faces_max) {
  const std::span<const std::uint32_t> indices = indices_of(faces);
  std::vector<geometry::Face> fewer(faces.size());
  fewer.resize(meshopt_simplify(fewer.front().data(), indices.data(), indices.size(), &vertices_m.front().x,
                                vertices_m.size(), sizeof(glm::vec3), 3 * faces_max, any_error, 0, nullptr) /
               3);
  return fewer;
}

/// Returns at most `faces_max` faces between the same vertices.
std::vector<geometry::Face> fewer_faces(const std::vector<glm::vec3>& vertices_m,
                                        const std::vector<geometry::Face>& faces, std::size_t faces_max) {
  const auto is_usable = [&](const std::vector<geometry::Face>& some) {
    return !some.empty() && some.size() <= faces_max;
  };
  if (is_usable(faces)) return faces;
  std::vector<geometry::Face> fewer = faces;
  if (faces.size() > simplified_faces_max) fewer = merged_faces(vertices_m, faces, simplified_faces_max);
  if (!fewer.empty()) fewer = simplified_faces(vertices_m, fewer, faces_max);
  if (!is_usable(fewer)) fewer = merged_faces(vertices_m, faces, faces_max);
  if (is_usable(fewer)) return fewer;
  const std::size_t stride = (faces.size() + faces_max - 1) / faces_max;
  fewer.clear();
  for (std::size_t i = 0; i < faces.size(); i += stride) fewer.push_back(faces[i]);
  return fewer;
}

/// Sets of face corners. Corner 3 n + i is corner i of face n.
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t corners) : parents_(corners) { std::iota(parents_.begin(), parents_.end(), 0u); }

  std::uint32_t find(std::uint32_t corner) {
    while (parents_[corner] != corner) corner = parents_[corner] = parents_[parents_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) { parents_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parents_;
};

constexpr std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

/// Normals of the vertices of a welded mesh. A vertex at a crease has a normal for each of its smooth surfaces.
class SmoothNormals {
 public:
  explicit SmoothNormals(const geometry::Mesh& mesh)
      : mesh_(mesh), groups_(3 * mesh.faces.size()), normals_(3 * mesh.faces.size(), glm::vec3{0.0f}) {
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
      area_normals_m2_.push_back(geometry::area_normal_m2(mesh, mesh.faces[face]));
    join_smooth_neighbors();
    for (std::uint32_t corner = 0; corner < normals_.size(); ++corner)
      normals_[groups_.find(corner)] += area_normals_m2_[corner / 3];
    for (glm::vec3& normal : normals_) {
      const float length = glm::length(normal);
      sizes_m2_.push_back(length);
      const bool has_direction = length > 0.0f && std::isfinite(length);
      normal = has_direction ? normal / length : glm::vec3{0.0f, 0.0f, 1.0f};
    }
  }

  /// Returns the smooth surface of a corner of the mesh.
  std::uint32_t surface_of(std::uint32_t corner) { return groups_.find(corner); }
  glm::vec3 normal(std::uint32_t surface) const { return normals_[surface]; }

  /// Returns the smooth surface at the vertex whose normal is nearest to `direction`. Ignores surfaces that are much
  /// smaller than another surface at the vertex, because the normals of tiny faces are not exact.
  std::uint32_t surface_at(std::uint32_t vertex, glm::vec3 direction) {
    if (first_corners_.empty()) list_corners();
    const auto best_of = [&](const auto& quality) {
      std::uint32_t best = groups_.find(first_corners_[vertex]);
      for (std::uint32_t corner = first_corners_[vertex]; corner != none; corner = next_corners_[corner])
        if (quality(groups_.find(corner)) > quality(best)) best = groups_.find(corner);
      return best;
    };
    const float largest_m2 = sizes_m2_[best_of([this](std::uint32_t surface) { return sizes_m2_[surface]; })];
    return best_of([&](std::uint32_t surface) {
      constexpr float worst = -std::numeric_limits<float>::infinity();
      return sizes_m2_[surface] < tiny_share * largest_m2 ? worst : glm::dot(normals_[surface], direction);
    });
  }

 private:
  /// Joins the corners of neighbor faces, unless the edge between the faces is a crease.
  void join_smooth_neighbors() {
    const geometry::Adjacency adjacency = geometry::find_neighbors(mesh_);
    const float crease_cosine = std::cos(crease_rad);
    for (std::uint32_t edge = 0; edge < normals_.size(); ++edge) {
      const geometry::HalfEdge other = adjacency.across(edge);
      if (!geometry::is_face_edge(other) || other < edge || geometry::is_flipped(mesh_, adjacency, edge)) continue;
      const glm::vec3 a = area_normals_m2_[edge / 3], b = area_normals_m2_[other / 3];
      if (glm::dot(a, b) < crease_cosine * glm::length(a) * glm::length(b)) continue;
      groups_.join(edge, next_corner(other));
      groups_.join(next_corner(edge), other);
    }
  }

  void list_corners() {
    first_corners_.assign(mesh_.vertices_m.size(), none);
    next_corners_.assign(normals_.size(), none);
    for (std::uint32_t corner = 0; corner < normals_.size(); ++corner) {
      std::uint32_t& first = first_corners_[mesh_.faces[corner / 3][corner % 3]];
      next_corners_[corner] = std::exchange(first, corner);
    }
  }

  const geometry::Mesh& mesh_;
  CornerGroups groups_;
  std::vector<glm::vec3> normals_;  // of the groups; the other elements are not used
  std::vector<float> sizes_m2_;     // of the groups
  std::vector<glm::vec3> area_normals_m2_;
  std::vector<std::uint32_t> first_corners_, next_corners_;  // lists of the corners at each vertex
};

bool encloses_volume(const geometry::Mesh& mesh) {
  const geometry::Adjacency adjacency = geometry::find_neighbors(mesh);
  if (!geometry::is_closed(adjacency)) return false;
  for (std::uint32_t edge = 0; edge < 3 * mesh.faces.size(); ++edge)
    if (geometry::is_flipped(mesh, adjacency, edge)) return false;
  double volume_m3 = 0.0;
  for (const geometry::Face& face : mesh.faces) volume_m3 += geometry::signed_volume_m3(mesh, face);
  return volume_m3 > 0.0;
}

/// The drawn vertices are in the order of their first use, which is the fastest order for drawing. The vertices of a
/// decimated mesh have the normals of the original mesh, because decimation can fold small faces.
void add_vertices(const geometry::Mesh& mesh, const std::vector<geometry::Face>& faces, DrawnMesh& drawn) {
  SmoothNormals normals(mesh);
  std::vector<std::uint32_t> vertex_of_surface(3 * mesh.faces.size(), none);
  for (std::uint32_t corner = 0; corner < 3 * faces.size(); ++corner) {
    const geometry::Face& face = faces[corner / 3];
    const std::uint32_t surface = drawn.is_decimated
                                      ? normals.surface_at(face[corner % 3], geometry::area_normal_m2(mesh, face))
                                      : normals.surface_of(corner);
    std::uint32_t& vertex = vertex_of_surface[surface];
    if (vertex == none) {
      vertex = static_cast<std::uint32_t>(drawn.vertices.size());
      drawn.vertices.push_back({mesh.vertices_m[face[corner % 3]], normals.normal(surface)});
    }
    drawn.indices.push_back(vertex);
  }
}

void add_shadow(const geometry::Mesh& mesh, const std::vector<geometry::Face>& faces, DrawnMesh& drawn) {
  std::vector<std::uint32_t> drawn_vertex(mesh.vertices_m.size(), none);
  for (std::size_t corner = 0; corner < drawn.indices.size(); ++corner)
    drawn_vertex[faces[corner / 3][corner % 3]] = drawn.indices[corner];
  const std::vector<geometry::Face> fewer = fewer_faces(mesh.vertices_m, faces, shadow_triangles_max);
  for (const std::uint32_t vertex : indices_of(fewer)) drawn.shadow_indices.push_back(drawn_vertex[vertex]);
}

/// Neighbor faces become neighbors in memory.
void optimize_order(std::vector<geometry::Face>& faces, std::size_t vertices) {
  std::vector<geometry::Face> ordered(faces.size());
  meshopt_optimizeVertexCache(ordered.front().data(), faces.front().data(), 3 * faces.size(), vertices);
  faces = std::move(ordered);
}

}  // namespace

DrawnMesh make_drawn_mesh(const geometry::Mesh& mesh) {
  DrawnMesh drawn;
  if (mesh.faces.empty() || !geometry::is_valid(mesh)) return drawn;
  geometry::Mesh welded = geometry::weld(mesh.vertices_m, mesh.faces);
  drawn.is_decimated = welded.faces.size() > drawn_triangles_max;
  std::vector<geometry::Face> fewer;
  if (drawn.is_decimated) fewer = fewer_faces(welded.vertices_m, welded.faces, drawn_triangles_max);
  std::vector<geometry::Face>& faces = drawn.is_decimated ? fewer : welded.faces;
  optimize_order(faces, welded.vertices_m.size());
  add_vertices(welded, faces, drawn);
  add_shadow(welded, faces, drawn);
  drawn.box = geometry::bounding_box(welded);
  drawn.is_solid = encloses_volume(welded);
  return drawn;
}

}  // namespace inkwell::window
