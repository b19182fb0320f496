// Search tree over the triangles of a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "host/geometry/adjacency.hpp"
#include "host/geometry/mesh.hpp"

namespace inkwell::geometry {

/// Receives the finished fraction, 0 to 1. If it returns false, the work is canceled.
using Progress = std::function<bool(double fraction)>;

/// Directions within an angle from an axis.
struct Cone {
  glm::vec3 axis{0, 0, 1};
  float angle_rad = 4;  ///< every direction from pi on
};

/// The smallest cone found that contains two cones.
Cone join(const Cone& left, const Cone& right);

/// Binary tree of boxes. A leaf has up to four consecutive faces, so the faces of the mesh are in the order of the
/// tree. Each node also has a cone of the surface normals around its faces. The queries do not allocate memory.
class Tree {
 public:
  static constexpr std::size_t leaf_faces_max = 4;
  static constexpr std::size_t depth_max = 64;

  /// 32 bytes, so that two nodes fill a cache line.
  struct Node {
    glm::vec3 minimum_m;
    std::uint32_t link;  ///< leaf: first face; otherwise second child. The first child is the next node.
    glm::vec3 maximum_m;
    /// Faces of a leaf, or 0: bits 0 to 3. Cone: axis on the octahedron in bits 4 to 23, angle in bits 24 to 31.
    std::uint32_t count_and_cone;

    std::uint32_t face_count() const { return count_and_cone & 15; }
  };

  /// Builds the tree, and reorders the faces of the mesh. `original_faces` receives the previous number of each face.
  /// Returns nothing if `progress` canceled the work.
  static std::optional<Tree> build(Mesh& mesh, std::vector<std::uint32_t>& original_faces, const Progress& progress);

  /// Sets the cones. `face_cones`: a cone per face that contains the normals of the faces at its corners.
  void set_cones(const std::vector<Cone>& face_cones);

  const std::vector<Node>& nodes() const { return nodes_; }
  bool is_empty() const { return nodes_.empty(); }

  /// Calls `visit(face)` for all faces with a box closer than the radius.
  template <class Visit>
  void visit_near(const glm::vec3& point_m, float radius_m, const Visit& visit) const {
    visit_if([&](const Node& node) { return squared_distance_m2(point_m, node) <= squared(padded_m(radius_m)); },
             visit);
  }

  /// As visit_near, but without faces that contain no local minimum of the distance from the point, judged by the
  /// cones of normals. `both_sides`: the back of a face counts too.
  template <class Visit>
  void visit_facing(const glm::vec3& point_m, float radius_m, bool both_sides, const Visit& visit) const {
    visit_if(
        [&](const Node& node) {
          return squared_distance_m2(point_m, node) <= squared(padded_m(radius_m)) && faces(point_m, node, both_sides);
        },
        visit);
  }

  /// Visits the faces in order of the distance of their boxes while `visit(face, radius_m)` shrinks the radius.
  template <class Visit>
  void visit_closest(const glm::vec3& point_m, float& radius_m, const Visit& visit) const {
    struct Waiting {
      std::uint32_t node;
      float squared_distance_m2;
    };
    if (nodes_.empty()) return;
    std::array<Waiting, depth_max + 1> stack;
    std::size_t count = 0;
    stack[count++] = {0, squared_distance_m2(point_m, nodes_[0])};
    while (count > 0) {
      const Waiting waiting = stack[--count];
      if (waiting.squared_distance_m2 > squared(padded_m(radius_m))) continue;
      const Node& node = nodes_[waiting.node];
      for (std::uint32_t face = node.link; face < node.link + node.face_count(); ++face) visit(face, radius_m);
      if (node.face_count() > 0) continue;
      Waiting first{waiting.node + 1, squared_distance_m2(point_m, nodes_[waiting.node + 1])};
      Waiting second{node.link, squared_distance_m2(point_m, nodes_[node.link])};
      if (first.squared_distance_m2 > second.squared_distance_m2) std::swap(first, second);
      stack[count++] = second;
      stack[count++] = first;
    }
  }

  /// Calls `visit(face)` for all faces with a box that the predicate `enters(node)` accepts.
  template <class Enter, class Visit>
  void visit_if(const Enter& enters, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, depth_max + 1> stack;
    std::size_t count = 0;
    stack[count++] = 0;
    while (count > 0) {
      const std::uint32_t index = stack[--count];
      const Node& node = nodes_[index];
      if (!enters(node)) continue;
      for (std::uint32_t face = node.link; face < node.link + node.face_count(); ++face) visit(face);
      if (node.face_count() > 0) continue;
      stack[count++] = node.link;
      stack[count++] = index + 1;
    }
  }

 private:
  static float squared(float value) { return value * value; }
  /// Covers the rounding of coordinates.
  float padded_m(float radius_m) const { return radius_m + padding_m_ + 1e-6f * radius_m; }
  static float squared_distance_m2(const glm::vec3& point_m, const Node& node) {
    const glm::vec3 way_m = glm::max(glm::max(node.minimum_m - point_m, point_m - node.maximum_m), glm::vec3{0});
    return glm::dot(way_m, way_m);
  }
  static bool faces(const glm::vec3& point_m, const Node& node, bool both_sides);

  std::vector<Node> nodes_;
  float padding_m_ = 0;
};

}  // namespace inkwell::geometry
