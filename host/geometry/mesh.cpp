#include "host/geometry/mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace inkwell::geometry {
namespace {

constexpr std::uint32_t empty_slot = 0xFFFFFFFF;

std::uint64_t hash(const glm::vec3& position_m) {
  constexpr std::uint64_t factor = 0x9E3779B97F4A7C15;
  std::uint64_t value = 0;
  for (int axis = 0; axis < 3; ++axis) {
    value = (value ^ std::bit_cast<std::uint32_t>(position_m[axis])) * factor;
    value ^= value >> 29;
  }
  return value;
}

/// Vertices with distinct positions, found by position. The table has at least twice as many slots as positions.
class Vertices {
 public:
  explicit Vertices(std::size_t count) : slots_(std::bit_ceil(2 * count + 2), empty_slot) {}

  /// Returns the index of the position, and adds the position if it is new.
  std::uint32_t index_of(glm::vec3 position_m) {
    position_m += 0.0f;  // -0 and 0 are equal positions with different bits
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash(position_m) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == empty_slot) {
        slots_[slot] = static_cast<std::uint32_t>(positions_m_.size());
        positions_m_.push_back(position_m);
        return slots_[slot];
      }
      if (positions_m_[slots_[slot]] == position_m) return slots_[slot];
    }
  }

  std::vector<glm::vec3> take() {
    positions_m_.shrink_to_fit();
    return std::move(positions_m_);
  }

 private:
  std::vector<std::uint32_t> slots_;
  std::vector<glm::vec3> positions_m_;
};

bool is_finite(const glm::vec3& vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

}  // namespace

bool is_valid(const Mesh& mesh) {
  const auto is_index = [&](std::uint32_t index) { return index < mesh.vertices_m.size(); };
  return mesh.faces.size() <= faces_max && std::ranges::all_of(mesh.vertices_m, is_finite) &&
         std::ranges::all_of(mesh.faces, [&](const Face& face) { return std::ranges::all_of(face, is_index); });
}

Box bounding_box(const Mesh& mesh) {
  Box box;
  for (const glm::vec3& vertex_m : mesh.vertices_m) {
    box.minimum_m = glm::min(box.minimum_m, vertex_m);
    box.maximum_m = glm::max(box.maximum_m, vertex_m);
  }
  return box;
}

glm::vec3 area_normal_m2(const Mesh& mesh, const Face& face) {
  const glm::vec3& corner_m = mesh.vertices_m[face[0]];
  return glm::cross(mesh.vertices_m[face[1]] - corner_m, mesh.vertices_m[face[2]] - corner_m);
}

Mesh weld(std::span<const glm::vec3> vertices_m, std::span<const Face> faces) {
  Vertices vertices(vertices_m.size());
  std::vector<std::uint32_t> welded(vertices_m.size(), empty_slot);
  Mesh mesh;
  mesh.faces.reserve(faces.size());
  for (const Face& face : faces) {
    Face& joined = mesh.faces.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::uint32_t& index = welded[face[corner]];
      if (index == empty_slot) index = vertices.index_of(vertices_m[face[corner]]);
      joined[corner] = index;
    }
  }
  mesh.vertices_m = vertices.take();
  return mesh;
}

Mesh weld(std::span<const glm::vec3> corners_m) {
  Vertices vertices(corners_m.size());
  Mesh mesh;
  mesh.faces.resize(corners_m.size() / 3);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face)
    for (std::size_t corner = 0; corner < 3; ++corner)
      mesh.faces[face][corner] = vertices.index_of(corners_m[3 * face + corner]);
  mesh.vertices_m = vertices.take();
  return mesh;
}

}  // namespace inkwell::geometry
