#include "host/geometry/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "host/geometry/topology.hpp"

namespace inkwell::geometry {
namespace {

/// A triangle below this height, relative to its longest edge or to the largest coordinate, has no usable normal in
/// single precision.
constexpr float needle_height_over_edge = 1e-6f, needle_height_over_coordinate = 5e-7f;

bool has_equal_corners(const Face& face) { return face[0] == face[1] || face[1] == face[2] || face[2] == face[0]; }

/// Removes faces and, if `sources` is not null, their source numbers.
std::size_t remove_faces(Mesh& mesh, const std::vector<bool>& is_removed, std::vector<std::uint32_t>* sources) {
  std::size_t kept = 0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (is_removed[face]) continue;
    if (sources != nullptr) (*sources)[kept] = (*sources)[face];
    mesh.faces[kept++] = mesh.faces[face];
  }
  const std::size_t removed = mesh.faces.size() - kept;
  mesh.faces.resize(kept);
  if (sources != nullptr) sources->resize(kept);
  return removed;
}

std::size_t remove_degenerate(Mesh& mesh, std::vector<std::uint32_t>* sources) {
  std::vector<bool> is_removed(mesh.faces.size());
  std::transform(mesh.faces.begin(), mesh.faces.end(), is_removed.begin(), has_equal_corners);
  return remove_faces(mesh, is_removed, sources);
}

void remove_unused_vertices(Mesh& mesh) {
  constexpr std::uint32_t unused = 0xFFFFFFFF;
  std::vector<std::uint32_t> numbers(mesh.vertices_m.size(), unused);
  for (const Face& face : mesh.faces)
    for (const std::uint32_t vertex : face) numbers[vertex] = 0;
  std::uint32_t kept = 0;
  for (std::size_t vertex = 0; vertex < numbers.size(); ++vertex) {
    if (numbers[vertex] == unused) continue;
    mesh.vertices_m[kept] = mesh.vertices_m[vertex];
    numbers[vertex] = kept++;
  }
  mesh.vertices_m.resize(kept);
  for (Face& face : mesh.faces)
    for (std::uint32_t& vertex : face) vertex = numbers[vertex];
}

// ---- Duplicates

struct Candidate {
  Face sorted;
  std::uint32_t face;
  bool is_even;           ///< orientation relative to the sorted corners
  bool is_first = false;  ///< the first of several copies

  bool has_corners_of(const Candidate& other) const { return sorted == other.sorted; }
};

Candidate candidate_of(const Mesh& mesh, std::uint32_t face) {
  Candidate candidate{mesh.faces[face], face, true};
  Face& corners = candidate.sorted;
  const auto order = [&](std::size_t first, std::size_t second) {
    if (corners[first] <= corners[second]) return;
    std::swap(corners[first], corners[second]);
    candidate.is_even = !candidate.is_even;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return candidate;
}

/// Faces that may have the corners of another face, sorted by their corners.
std::vector<Candidate> duplicate_candidates(const Mesh& mesh, const Adjacency& adjacency) {
  std::vector<Candidate> candidates;
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    const auto& edges = adjacency.neighbors[face];
    const bool is_branched = std::ranges::find(edges, branched) != edges.end();
    const bool has_one_neighbor = is_face_edge(edges[0]) && is_face_edge(edges[1]) && edges[0] / 3 == edges[1] / 3;
    if (is_branched || has_one_neighbor) candidates.push_back(candidate_of(mesh, face));
  }
  std::ranges::sort(candidates, {},
                    [](const Candidate& candidate) { return std::tie(candidate.sorted, candidate.face); });
  return candidates;
}

/// Some programs write both sides of each face. These two layers have no volume, so one is removed. Two bodies that
/// share a wall also contain opposite faces, but those are only a few faces of a part.
void mark_second_sides(const Mesh& mesh, const Adjacency& adjacency, const std::vector<Candidate>& opposite,
                       std::vector<bool>& is_removed) {
  if (opposite.empty()) return;
  const Topology topology = find_topology(mesh, adjacency);
  std::vector<std::size_t> unpaired(topology.is_closed.size());
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
    if (!is_removed[face]) ++unpaired[topology.part_of_face[face]];
  for (const Candidate& second : opposite) unpaired[topology.part_of_face[second.face]] -= 2;
  for (const Candidate& second : opposite)
    if (unpaired[topology.part_of_face[second.face]] == 0) is_removed[second.face] = true;
}

/// True if each edge of the face is used equally often in both directions.
bool is_balanced(const std::vector<BranchedEdge>& branches, const Face& face) {
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const std::pair<std::uint32_t, std::uint32_t> vertices = std::minmax(face[corner], face[(corner + 1) % 3]);
    const auto begin = std::ranges::lower_bound(branches, vertices, {}, &BranchedEdge::vertices);
    const auto end = std::ranges::upper_bound(branches, vertices, {}, &BranchedEdge::vertices);
    if (2 * std::count_if(begin, end, [](const BranchedEdge& branch) { return branch.is_forward; }) != end - begin)
      return false;
  }
  return true;
}

/// Two bodies may share a face, for example a cone on a cylinder of the same radius. Without its copy of the face, one
/// body would be open. A part of which each face has a copy was written twice.
void mark_copies(const Mesh& mesh, const Adjacency& adjacency, const std::vector<Candidate>& copies,
                 std::vector<bool>& is_removed) {
  if (copies.empty()) return;
  const Topology topology = find_topology(mesh, adjacency);
  const auto branches = find_branched_edges(mesh, adjacency);
  std::vector<std::size_t> not_copied(topology.is_closed.size());
  for (const std::uint32_t part : topology.part_of_face) ++not_copied[part];
  for (const Candidate& copy : copies) not_copied[topology.part_of_face[copy.face]] -= copy.is_first ? 2 : 1;
  for (const Candidate& copy : copies)
    if (not_copied[topology.part_of_face[copy.face]] == 0 || !is_balanced(branches, mesh.faces[copy.face]))
      is_removed[copy.face] = true;
}

std::size_t remove_duplicates(Mesh& mesh, const Adjacency& adjacency, std::vector<std::uint32_t>* sources) {
  auto candidates = duplicate_candidates(mesh, adjacency);
  std::vector<bool> is_removed(mesh.faces.size());
  std::vector<Candidate> copies, opposite;
  for (auto first = candidates.begin(); first != candidates.end();) {
    const auto next =
        std::find_if(first, candidates.end(), [&](const Candidate& other) { return !other.has_corners_of(*first); });
    std::array<std::size_t, 2> sides{};
    for (auto other = first; other != next; ++other) {
      const std::size_t number = ++sides[other->is_even == first->is_even ? 0 : 1];
      other->is_first = number == 2;
      if (number > 1) copies.push_back(*other);
      if (number == 1 && other->is_even != first->is_even) opposite.push_back(*other);
    }
    first = next;
  }
  mark_copies(mesh, adjacency, copies, is_removed);
  mark_second_sides(mesh, adjacency, opposite, is_removed);
  return remove_faces(mesh, is_removed, sources);
}

// ---- Orientation

/// Gives all faces that are connected by edges of two faces the orientation of the majority. Returns the number of
/// turned faces.
std::size_t unify_orientation(Mesh& mesh, const Adjacency& adjacency) {
  enum class Orientation : std::uint8_t { unknown, kept, turned };
  std::vector<Orientation> orientations(mesh.faces.size(), Orientation::unknown);
  std::vector<std::uint32_t> connected;
  std::size_t turned = 0;
  for (std::uint32_t start = 0; start < mesh.faces.size(); ++start) {
    if (orientations[start] != Orientation::unknown) continue;
    connected.assign(1, start);
    orientations[start] = Orientation::kept;
    std::size_t against_start = 0;
    for (std::size_t next = 0; next < connected.size(); ++next) {
      const std::uint32_t face = connected[next];
      for (HalfEdge edge = 3 * face; edge < 3 * face + 3; ++edge) {
        const HalfEdge neighbor = adjacency.across(edge);
        if (!is_face_edge(neighbor) || orientations[neighbor / 3] != Orientation::unknown) continue;
        const bool is_turned = (orientations[face] == Orientation::turned) != is_flipped(mesh, adjacency, edge);
        orientations[neighbor / 3] = is_turned ? Orientation::turned : Orientation::kept;
        against_start += is_turned ? 1 : 0;
        connected.push_back(neighbor / 3);
      }
    }
    const bool is_start_in_majority = 2 * against_start <= connected.size();
    const auto wrong = is_start_in_majority ? Orientation::turned : Orientation::kept;
    for (const std::uint32_t face : connected) {
      if (orientations[face] != wrong) continue;
      std::swap(mesh.faces[face][1], mesh.faces[face][2]);
      ++turned;
    }
  }
  return turned;
}

/// A closed part of a mesh.
struct Part {
  std::vector<std::uint32_t> faces{};
  Box box{};
  double volume_m3 = 0;
  bool is_turned = false;

  bool contains(const Box& other) const {
    return glm::all(glm::lessThanEqual(box.minimum_m, other.minimum_m)) &&
           glm::all(glm::greaterThanEqual(box.maximum_m, other.maximum_m));
  }
};

std::vector<Part> closed_parts(const Mesh& mesh, const Topology& topology) {
  std::vector<Part> parts(topology.is_closed.size());
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    const std::uint32_t number = topology.part_of_face[face];
    if (!topology.is_closed[number]) continue;
    Part& part = parts[number];
    part.faces.push_back(face);
    part.volume_m3 += signed_volume_m3(mesh, mesh.faces[face]);
    for (const std::uint32_t vertex : mesh.faces[face]) {
      part.box.minimum_m = glm::min(part.box.minimum_m, mesh.vertices_m[vertex]);
      part.box.maximum_m = glm::max(part.box.maximum_m, mesh.vertices_m[vertex]);
    }
  }
  std::erase_if(parts, [](const Part& part) { return part.faces.empty(); });
  return parts;
}

bool is_inside(const Mesh& mesh, const Part& inner, const Part& outer) {
  const glm::vec3 point_m = mesh.vertices_m[mesh.faces[inner.faces[0]][0]];
  double share = 0;
  for (const std::uint32_t face : outer.faces) share += winding_share(mesh, mesh.faces[face], point_m);
  return std::abs(share) > 0.5;
}

/// Returns the number of turned parts. The outermost parts must have positive volumes. A part inside another part keeps
/// its orientation relative to that part, because a cavity has a negative volume.
std::size_t turn_parts(Mesh& mesh, const Topology& topology) {
  auto parts = closed_parts(mesh, topology);
  std::ranges::sort(parts, std::greater{}, [](const Part& part) { return std::abs(part.volume_m3); });
  std::size_t turned = 0;
  for (std::size_t number = 0; number < parts.size(); ++number) {
    Part& part = parts[number];
    // The smallest enclosing part is the nearest larger one.
    const Part* outer = nullptr;
    for (std::size_t larger = number; larger-- > 0 && outer == nullptr;)
      if (parts[larger].contains(part.box) && is_inside(mesh, part, parts[larger])) outer = &parts[larger];
    part.is_turned = outer != nullptr ? outer->is_turned : part.volume_m3 < 0;
    if (part.is_turned) ++turned;
  }
  for (const Part& part : parts)
    if (part.is_turned)
      for (const std::uint32_t face : part.faces) std::swap(mesh.faces[face][1], mesh.faces[face][2]);
  return turned;
}

// ---- Needles

/// Corner, opposite edge and height of a face over its longest edge.
struct Height {
  HalfEdge longest_edge;
  float height_m;
  float edge_m;
};

Height height_of(const Mesh& mesh, std::uint32_t face) {
  const Face& corners = mesh.faces[face];
  Height height{3 * face, 0, 0};
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    const float edge_m = glm::distance(mesh.vertices_m[corners[corner]], mesh.vertices_m[corners[(corner + 1) % 3]]);
    if (edge_m > height.edge_m) height = {3 * face + corner, 0, edge_m};
  }
  const glm::dvec3 first_m(mesh.vertices_m[corners[0]]);
  const glm::dvec3 normal_m2 =
      glm::cross(glm::dvec3(mesh.vertices_m[corners[1]]) - first_m, glm::dvec3(mesh.vertices_m[corners[2]]) - first_m);
  if (height.edge_m > 0) height.height_m = static_cast<float>(glm::length(normal_m2) / height.edge_m);
  return height;
}

constexpr HalfEdge next_in_face(HalfEdge edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }

/// Replaces needles, one by one. A needle (a, c, b), whose corner b lies on the edge from a to c, and its neighbor
/// (c, a, d) become (a, d, b) and (d, c, b). The surface moves by at most the height of the needle.
class NeedleRepair {
 public:
  /// Keeps the adjacency up to date while no face is removed.
  NeedleRepair(Mesh& mesh, Adjacency& adjacency) : mesh_(mesh), adjacency_(adjacency) {
    const Box box = bounding_box(mesh);
    const glm::vec3 largest_m = glm::max(glm::abs(box.minimum_m), glm::abs(box.maximum_m));
    height_m_ = needle_height_over_coordinate * std::max({largest_m.x, largest_m.y, largest_m.z});
  }

  void run(Repairs& repairs, std::vector<std::uint32_t>* sources) {
    std::vector<bool> is_removed(mesh_.faces.size());
    // Each swap may leave a lower needle next to it, which the next pass replaces.
    constexpr int passes = 8;
    for (int pass = 0; pass < passes; ++pass) {
      bool has_swapped = false;
      for (std::uint32_t face = 0; face < mesh_.faces.size(); ++face) {
        const Height height = height_of(mesh_, face);
        if (is_removed[face] || !is_needle(height)) continue;
        if (adjacency_.across(height.longest_edge) == boundary) {
          detach(face);
          is_removed[face] = true;
          ++repairs.degenerate;
        } else if (swap(height)) {
          has_swapped = true;
          ++repairs.needles;
        }
      }
      if (!has_swapped) break;
    }
    if (repairs.degenerate > 0) remove_faces(mesh_, is_removed, sources);
  }

 private:
  bool is_needle(const Height& height) const {
    return height.height_m <= std::max(height_m_, needle_height_over_edge * height.edge_m);
  }

  std::uint32_t start_of(HalfEdge edge) const { return mesh_.faces[edge / 3][edge % 3]; }

  void link(HalfEdge edge, HalfEdge neighbor) {
    adjacency_.neighbors[edge / 3][edge % 3] = neighbor;
    if (is_face_edge(neighbor)) adjacency_.neighbors[neighbor / 3][neighbor % 3] = edge;
  }

  void detach(std::uint32_t face) {
    for (HalfEdge edge = 3 * face; edge < 3 * face + 3; ++edge) {
      const HalfEdge neighbor = adjacency_.across(edge);
      if (is_face_edge(neighbor)) adjacency_.neighbors[neighbor / 3][neighbor % 3] = boundary;
    }
  }

  /// False if the swap is impossible, or if it does not raise the lowest height.
  bool swap(const Height& height) {
    const HalfEdge edge = height.longest_edge, neighbor = adjacency_.across(edge);
    if (!is_face_edge(neighbor) || neighbor / 3 == edge / 3 || is_flipped(mesh_, adjacency_, edge)) return false;
    const std::uint32_t face = edge / 3, other = neighbor / 3;
    const HalfEdge c_b = next_in_face(edge), b_a = next_in_face(c_b);
    const HalfEdge a_d = next_in_face(neighbor), d_c = next_in_face(a_d);
    const std::uint32_t a = start_of(edge), c = start_of(c_b), b = start_of(b_a), d = start_of(d_c);
    if (b == d || are_connected(b_a, d)) return false;
    const HalfEdge outside_a_d = adjacency_.across(a_d), outside_b_a = adjacency_.across(b_a);
    const HalfEdge outside_d_c = adjacency_.across(d_c), outside_c_b = adjacency_.across(c_b);
    const Face old_face = mesh_.faces[face], old_other = mesh_.faces[other];
    const float lowest_m = std::min(height.height_m, height_of(mesh_, other).height_m);
    mesh_.faces[face] = {a, d, b};
    mesh_.faces[other] = {d, c, b};
    if (std::min(height_of(mesh_, face).height_m, height_of(mesh_, other).height_m) <= lowest_m) {
      mesh_.faces[face] = old_face;
      mesh_.faces[other] = old_other;
      return false;
    }
    link(3 * face, outside_a_d);
    link(3 * face + 1, 3 * other + 2);
    link(3 * face + 2, outside_b_a);
    link(3 * other, outside_d_c);
    link(3 * other + 1, outside_c_b);
    return true;
  }

  /// True if a face at the start vertex of the half-edge contains the other vertex. Also true if the faces around the
  /// start vertex are not a single fan.
  bool are_connected(HalfEdge start, std::uint32_t other) const {
    HalfEdge edge = start;
    constexpr int faces_around_vertex_max = 1000;
    for (int count = 0; count < faces_around_vertex_max; ++count) {
      const HalfEdge next = next_in_face(edge);
      if (start_of(next) == other || start_of(next_in_face(next)) == other) return true;
      const HalfEdge incoming = next_in_face(next);
      const HalfEdge neighbor = adjacency_.across(incoming);
      if (!is_face_edge(neighbor) || is_flipped(mesh_, adjacency_, incoming)) return true;
      if (neighbor == start) return false;
      edge = neighbor;
    }
    return true;
  }

  Mesh& mesh_;
  Adjacency& adjacency_;
  float height_m_ = 0;
};

Measurements measure_parts(const Mesh& mesh, const Topology& topology) {
  Measurements found;
  found.triangles = mesh.faces.size();
  found.vertices = mesh.vertices_m.size();
  found.parts = topology.is_closed.size();
  found.closed_parts = static_cast<std::size_t>(std::ranges::count(topology.is_closed, true));
  found.open_edges = topology.open_edges;
  found.branched_edges = topology.branched_edges;
  found.flipped_edges = topology.flipped_edges;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    found.area_m2 += 0.5 * static_cast<double>(glm::length(area_normal_m2(mesh, mesh.faces[face])));
    if (topology.is_closed[topology.part_of_face[face]]) found.volume_m3 += signed_volume_m3(mesh, mesh.faces[face]);
  }
  found.box = bounding_box(mesh);
  return found;
}

}  // namespace

Measurements measure(const Mesh& mesh) { return measure_parts(mesh, find_topology(mesh, find_neighbors(mesh))); }

Report repair(Mesh& mesh, std::vector<std::uint32_t>* sources) {
  Repairs repairs;
  if (sources != nullptr) {
    sources->resize(mesh.faces.size());
    std::iota(sources->begin(), sources->end(), 0u);
  }
  repairs.degenerate = remove_degenerate(mesh, sources);
  Adjacency adjacency = find_neighbors(mesh);
  repairs.duplicates = remove_duplicates(mesh, adjacency, sources);
  if (repairs.duplicates > 0) adjacency = find_neighbors(mesh);
  repairs.turned = unify_orientation(mesh, adjacency);
  if (repairs.turned > 0) adjacency = find_neighbors(mesh);
  Repairs flat;
  NeedleRepair(mesh, adjacency).run(flat, sources);
  if (flat.degenerate > 0) adjacency = find_neighbors(mesh);
  repairs.degenerate += flat.degenerate;
  repairs.needles = flat.needles;
  // Turning a whole part changes neither its edges nor its closedness.
  const Topology topology = find_topology(mesh, adjacency);
  repairs.turned_parts = turn_parts(mesh, topology);
  if (repairs.any()) remove_unused_vertices(mesh);
  return {measure_parts(mesh, topology), repairs};
}

}  // namespace inkwell::geometry
