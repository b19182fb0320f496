// Search tree over the triangles of a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
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

inline float square(float value) { return value * value; }

/// As std::max, but the compiler needs only one instruction for it.
inline float larger(float left, float right) { return left > right ? left : right; }

/// Four numbers that one instruction processes (vector extension of GCC and Clang).
typedef float Four __attribute__((vector_size(16)));

/// Binary tree of boxes. A leaf has up to four consecutive faces, so the faces of the mesh are in the order of the
/// tree. Each node also has a cone of the surface normals around its faces (Johnson and Cohen, 2001). The queries do
/// not allocate memory.
class Tree {
 public:
  static constexpr std::size_t leaf_faces_max = 4;
  static constexpr std::size_t depth_max = 64;

  /// One cache line. All vertices of the node's faces are in the box and in a cylinder around the middle of the box.
  /// The cylinder is much flatter than the box if the faces form a flat, inclined patch.
  struct alignas(64) Node {
    glm::vec3 minimum_m;
    std::uint32_t link;  ///< leaf: first face; otherwise second child. The first child is the next node.
    glm::vec3 maximum_m;
    std::uint32_t face_count;  ///< of a leaf, otherwise 0
    glm::vec3 axis{0};         ///< of the cone of normals
    float cosine = -1;         ///< of the cone's angle; -1: every direction
    float sine = 0;
    float bottom_m = 0;  ///< of the cylinder: least product of axis and vertex
    float top_m = 0;     ///< of the cylinder: largest product
    float radius_m = 0;  ///< of the cylinder. 0: there is no cylinder

    glm::vec3 middle_m() const { return (minimum_m + maximum_m) * 0.5f; }
    bool has_cylinder() const { return radius_m > 0; }

    /// Not above the squared distance of any face of the node. If the distance exceeds `limit_m2`, a lower bound.
    float squared_distance_m2(const glm::vec3& point_m, float limit_m2) const {
      // The fourth element is not used. 1 avoids slow arithmetic with tiny numbers.
      const Four point{point_m.x, point_m.y, point_m.z, 1};
      Four low;
      Four high;
      std::memcpy(&low, &minimum_m, sizeof low);
      std::memcpy(&high, &maximum_m, sizeof high);
      const Four below = low - point;
      const Four above = point - high;
      const Four farther = below > above ? below : above;
      const Four outside = farther > 0 ? farther : Four{};
      const Four squares = outside * outside;
      const float sum_m2 = squares[0] + squares[1] + squares[2];
      if (sum_m2 > limit_m2 || !has_cylinder()) return sum_m2;
      const float height_m = glm::dot(axis, point_m);
      const float above_m = larger(larger(height_m - top_m, bottom_m - height_m), 0.0f);
      const glm::vec3 way_m = point_m - middle_m();
      const float squared_m2 = larger(glm::dot(way_m, way_m) - square(glm::dot(axis, way_m)), 0.0f);
      const float beside_m = larger(std::sqrt(squared_m2) - radius_m, 0.0f);
      return larger(sum_m2, square(above_m) + square(beside_m));
    }
  };

  /// Builds the tree, and reorders the faces of the mesh. `original_faces` receives the previous number of each face.
  /// Returns nothing if `progress` canceled the work.
  static std::optional<Tree> build(Mesh& mesh, std::vector<std::uint32_t>& original_faces, const Progress& progress);

  /// Sets the cones and planes. `face_cones`: a cone per face that contains the normals of the faces at its corners.
  void set_cones(const Mesh& mesh, const std::vector<Cone>& face_cones);

  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t memory_bytes() const { return nodes_.capacity() * sizeof(Node); }
  /// Largest rounding error of the boxes.
  float padding_m() const { return padding_m_; }
  /// A radius that covers the rounding of coordinates.
  float padded_m(float radius_m) const { return radius_m + padding_m_ + 1e-6f * radius_m; }
  bool is_empty() const { return nodes_.empty(); }

  /// Calls `visit(face)` for all faces of nodes closer than the radius.
  template <class Visit>
  void visit_near(const glm::vec3& point_m, float radius_m, const Visit& visit) const {
    const float squared_radius_m2 = square(padded_m(radius_m));
    visit_if(
        [&](const Node& node) { return node.squared_distance_m2(point_m, squared_radius_m2) <= squared_radius_m2; },
        visit);
  }

  /// As visit_near, but without faces that contain no local minimum of the distance from the point, judged by the
  /// cones of normals. `both_sides`: the back of a face counts too.
  template <class Visit>
  void visit_facing(const glm::vec3& point_m, float radius_m, bool both_sides, const Visit& visit) const {
    const float squared_radius_m2 = square(padded_m(radius_m));
    visit_if(
        [&](const Node& node) {
          return node.squared_distance_m2(point_m, squared_radius_m2) <= squared_radius_m2 &&
                 faces(point_m, node, both_sides);
        },
        visit);
  }

  /// Visits the faces in order of the distance of their nodes while `visit(face, radius_m)` shrinks the radius. Nodes
  /// that the predicate `enters(node)` refuses are omitted.
  template <class Enter, class Visit>
  void visit_closest_if(const glm::vec3& point_m, float& radius_m, const Enter& enters, const Visit& visit) const {
    struct Waiting {
      std::uint32_t node;
      float squared_distance_m2;
    };
    if (nodes_.empty()) return;
    std::array<Waiting, depth_max + 1> stack;
    std::size_t count = 0;
    const auto push = [&](std::uint32_t node, float node_m2) {
      if (node_m2 <= square(padded_m(radius_m)) && enters(nodes_[node])) stack[count++] = {node, node_m2};
    };
    const auto distance_m2 = [&](std::uint32_t node) {
      return nodes_[node].squared_distance_m2(point_m, square(padded_m(radius_m)));
    };
    push(0, distance_m2(0));
    while (count > 0) {
      const Waiting waiting = stack[--count];
      if (waiting.squared_distance_m2 > square(padded_m(radius_m))) continue;
      const Node& node = nodes_[waiting.node];
      for (std::uint32_t face = node.link; face < node.link + node.face_count; ++face) visit(face, radius_m);
      if (node.face_count > 0) continue;
      const float first_m2 = distance_m2(waiting.node + 1);
      const float second_m2 = distance_m2(node.link);
      const bool first_is_closer = first_m2 <= second_m2;
      push(first_is_closer ? node.link : waiting.node + 1, std::max(first_m2, second_m2));
      push(first_is_closer ? waiting.node + 1 : node.link, std::min(first_m2, second_m2));
    }
  }

  /// Calls `visit(face)` for all faces of nodes that the predicate `enters(node)` accepts.
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
      for (std::uint32_t face = node.link; face < node.link + node.face_count; ++face) visit(face);
      if (node.face_count > 0) continue;
      stack[count++] = node.link;
      stack[count++] = index + 1;
    }
  }

 private:
  static bool faces(const glm::vec3& point_m, const Node& node, bool both_sides);

  std::vector<Node> nodes_;
  float padding_m_ = 0;
};

}  // namespace inkwell::geometry
