#include "host/geometry/topology.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

namespace inkwell::geometry {
namespace {

/// Disjoint sets of numbers.
class Sets {
 public:
  explicit Sets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
  std::uint32_t find(std::uint32_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
  }
  void join(std::uint32_t first, std::uint32_t second) {
    const std::uint32_t first_set = find(first), second_set = find(second);
    parents_[std::max(first_set, second_set)] = std::min(first_set, second_set);
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace

std::vector<BranchedEdge> find_branched_edges(const Mesh& mesh, const Adjacency& adjacency) {
  std::vector<BranchedEdge> found;
  for (HalfEdge edge = 0; edge < 3 * mesh.faces.size(); ++edge) {
    if (adjacency.across(edge) != branched) continue;
    const Face& face = mesh.faces[edge / 3];
    const std::uint32_t from = face[edge % 3], to = face[(edge % 3 + 1) % 3];
    found.push_back({std::minmax(from, to), edge, from < to});
  }
  std::ranges::sort(found, {}, [](const BranchedEdge& branch) { return std::pair(branch.vertices, branch.edge); });
  return found;
}

Topology find_topology(const Mesh& mesh, const Adjacency& adjacency) {
  const auto count = static_cast<std::uint32_t>(mesh.faces.size());
  Topology topology;
  Sets sets(count);
  std::vector<std::uint32_t> faces_of_open_parts;
  for (HalfEdge edge = 0; edge < 3 * count; ++edge) {
    const HalfEdge neighbor = adjacency.across(edge);
    if (neighbor == boundary) {
      ++topology.open_edges;
      faces_of_open_parts.push_back(edge / 3);
    } else if (is_face_edge(neighbor) && edge < neighbor) {
      sets.join(edge / 3, neighbor / 3);
      if (!is_flipped(mesh, adjacency, edge)) continue;
      ++topology.flipped_edges;
      faces_of_open_parts.push_back(edge / 3);
    }
  }
  const auto branches = find_branched_edges(mesh, adjacency);
  for (auto first = branches.begin(); first != branches.end();) {
    const auto next =
        std::find_if(first, branches.end(), [&](const auto& branch) { return branch.vertices != first->vertices; });
    const auto forward = std::count_if(first, next, [](const BranchedEdge& branch) { return branch.is_forward; });
    for (auto branch = first; branch != next; ++branch) sets.join(first->edge / 3, branch->edge / 3);
    const bool is_line = first->vertices.first == first->vertices.second;
    if (!is_line) ++topology.branched_edges;
    if (is_line || 2 * forward != next - first) faces_of_open_parts.push_back(first->edge / 3);
    first = next;
  }

  std::vector<std::uint32_t> numbers(count, count);
  topology.part_of_face.reserve(count);
  for (std::uint32_t face = 0; face < count; ++face) {
    std::uint32_t& number = numbers[sets.find(face)];
    if (number == count) {
      number = static_cast<std::uint32_t>(topology.is_closed.size());
      topology.is_closed.push_back(true);
    }
    topology.part_of_face.push_back(number);
  }
  for (const std::uint32_t face : faces_of_open_parts) topology.is_closed[topology.part_of_face[face]] = false;
  return topology;
}

double signed_volume_m3(const Mesh& mesh, const Face& face) {
  const glm::dvec3 first_m(mesh.vertices_m[face[0]]);
  return glm::dot(first_m, glm::cross(glm::dvec3(mesh.vertices_m[face[1]]), glm::dvec3(mesh.vertices_m[face[2]]))) / 6;
}

double winding_share(const Mesh& mesh, const Face& face, const glm::vec3& point_m) {
  // Van Oosterom and Strackee 1983, "The solid angle of a plane triangle".
  const auto from_point = [&](std::size_t corner) {
    return glm::dvec3(mesh.vertices_m[face[corner]]) - glm::dvec3(point_m);
  };
  const glm::dvec3 a = from_point(0), b = from_point(1), c = from_point(2);
  const double length_a = glm::length(a), length_b = glm::length(b), length_c = glm::length(c);
  const double determinant = glm::dot(a, glm::cross(b, c));
  const double divisor = length_a * length_b * length_c + glm::dot(a, b) * length_c + glm::dot(b, c) * length_a +
                         glm::dot(c, a) * length_b;
  return std::atan2(determinant, divisor) / (2 * std::numbers::pi);
}

}  // namespace inkwell::geometry
