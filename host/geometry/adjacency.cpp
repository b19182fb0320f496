#include "host/geometry/adjacency.hpp"

#include <algorithm>

namespace inkwell::geometry {
namespace {

/// An edge of a face, filed under its vertex with the lower index.
struct FiledEdge {
  std::uint32_t other_vertex;
  HalfEdge edge;
};

}  // namespace

Adjacency find_neighbors(const Mesh& mesh) {
  // A counting sort files the edges, because sorting them by comparison takes five times as long.
  const auto ends = [&](HalfEdge edge) {
    const Face& face = mesh.faces[edge / 3];
    return std::minmax(face[edge % 3], face[(edge % 3 + 1) % 3]);
  };
  const auto edge_count = static_cast<HalfEdge>(3 * mesh.faces.size());
  std::vector<std::uint32_t> starts(mesh.vertices_m.size() + 2);
  for (HalfEdge edge = 0; edge < edge_count; ++edge) ++starts[ends(edge).first + 2];
  for (std::size_t vertex = 2; vertex < starts.size(); ++vertex) starts[vertex] += starts[vertex - 1];
  std::vector<FiledEdge> filed(edge_count);
  for (HalfEdge edge = 0; edge < edge_count; ++edge) {
    const auto [lower, higher] = ends(edge);
    filed[starts[lower + 1]++] = {higher, edge};
  }

  Adjacency adjacency;
  adjacency.neighbors.resize(mesh.faces.size(), {boundary, boundary, boundary});
  const auto set = [&](HalfEdge edge, HalfEdge neighbor) { adjacency.neighbors[edge / 3][edge % 3] = neighbor; };
  for (std::size_t vertex = 0; vertex < mesh.vertices_m.size(); ++vertex) {
    const auto begin = filed.begin() + starts[vertex];
    const auto end = filed.begin() + starts[vertex + 1];
    std::sort(begin, end, [](const FiledEdge& left, const FiledEdge& right) {
      return left.other_vertex != right.other_vertex ? left.other_vertex < right.other_vertex : left.edge < right.edge;
    });
    for (auto first = begin; first != end;) {
      auto next = first;
      while (next != end && next->other_vertex == first->other_vertex) ++next;
      if (first->other_vertex == vertex || next - first > 2) {
        for (auto edge = first; edge != next; ++edge) set(edge->edge, branched);
      } else if (next - first == 2) {
        set(first[0].edge, first[1].edge);
        set(first[1].edge, first[0].edge);
      }
      first = next;
    }
  }
  return adjacency;
}

bool is_flipped(const Mesh& mesh, const Adjacency& adjacency, HalfEdge edge) {
  const HalfEdge neighbor = adjacency.across(edge);
  return is_face_edge(neighbor) && mesh.faces[edge / 3][edge % 3] == mesh.faces[neighbor / 3][neighbor % 3];
}

bool is_closed(const Adjacency& adjacency) {
  return std::ranges::all_of(adjacency.neighbors,
                             [](const auto& edges) { return std::ranges::all_of(edges, is_face_edge); });
}

}  // namespace inkwell::geometry
