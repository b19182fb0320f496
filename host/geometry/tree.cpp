#include "host/geometry/tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace inkwell::geometry {
namespace {

constexpr float pi_rad = std::numbers::pi_v<float>;
constexpr std::size_t bin_count = 16;

/// A face while the tree is built.
struct Item {
  glm::vec3 minimum_m, maximum_m;
  std::uint32_t face;

  glm::vec3 doubled_middle_m() const { return minimum_m + maximum_m; }
};

void extend(Box& box, const glm::vec3& minimum_m, const glm::vec3& maximum_m) {
  box.minimum_m = glm::min(box.minimum_m, minimum_m);
  box.maximum_m = glm::max(box.maximum_m, maximum_m);
}

float half_area_m2(const Box& box) {
  const glm::vec3 size_m = box.maximum_m - box.minimum_m;
  return size_m.x * size_m.y + size_m.y * size_m.z + size_m.z * size_m.x;
}

struct Bin {
  Box box;
  std::size_t count = 0;
};

using Items = std::vector<Item>;
using Position = Items::iterator;

/// Splits the items at the bin border with the least sum of area times count (surface area heuristic). Returns the
/// middle if all items are in one bin.
Position split(Position begin, Position end, bool halve) {
  Box middles;
  for (auto item = begin; item != end; ++item) extend(middles, item->doubled_middle_m(), item->doubled_middle_m());
  const glm::vec3 size_m = middles.maximum_m - middles.minimum_m;
  const int axis = size_m.x >= size_m.y && size_m.x >= size_m.z ? 0 : size_m.y >= size_m.z ? 1 : 2;
  const auto half = begin + (end - begin) / 2;
  if (!(size_m[axis] > 0)) return half;
  if (halve) {
    std::nth_element(begin, half, end, [axis](const Item& left, const Item& right) {
      return left.doubled_middle_m()[axis] < right.doubled_middle_m()[axis];
    });
    return half;
  }

  const float scale = bin_count / size_m[axis];
  const auto bin_of = [&](const Item& item) {
    const float position = (item.doubled_middle_m()[axis] - middles.minimum_m[axis]) * scale;
    return std::min(static_cast<std::size_t>(position), bin_count - 1);
  };
  std::array<Bin, bin_count> bins;
  for (auto item = begin; item != end; ++item) {
    Bin& bin = bins[bin_of(*item)];
    extend(bin.box, item->minimum_m, item->maximum_m);
    ++bin.count;
  }
  std::array<float, bin_count> cost_above{};
  Bin above;
  for (std::size_t bin = bin_count - 1; bin > 0; --bin) {
    extend(above.box, bins[bin].box.minimum_m, bins[bin].box.maximum_m);
    above.count += bins[bin].count;
    cost_above[bin] = above.count > 0 ? half_area_m2(above.box) * static_cast<float>(above.count) : 0;
  }
  Bin below;
  std::size_t best = 0;
  float least = 0;
  for (std::size_t bin = 1; bin < bin_count; ++bin) {
    extend(below.box, bins[bin - 1].box.minimum_m, bins[bin - 1].box.maximum_m);
    below.count += bins[bin - 1].count;
    if (below.count == 0 || below.count == static_cast<std::size_t>(end - begin)) continue;
    const float cost = half_area_m2(below.box) * static_cast<float>(below.count) + cost_above[bin];
    if (best == 0 || cost < least) {
      best = bin;
      least = cost;
    }
  }
  if (best == 0) return half;
  return std::partition(begin, end, [&](const Item& item) { return bin_of(item) < best; });
}

float angle_between_rad(const glm::vec3& left, const glm::vec3& right) {
  return 2 * std::atan2(glm::length(left - right), glm::length(left + right));
}

}  // namespace

Cone join(const Cone& left, const Cone& right) {
  if (left.angle_rad >= pi_rad || right.angle_rad >= pi_rad) return {};
  const float between_rad = angle_between_rad(left.axis, right.axis);
  if (between_rad + right.angle_rad <= left.angle_rad) return left;
  if (between_rad + left.angle_rad <= right.angle_rad) return right;
  const float angle_rad = (between_rad + left.angle_rad + right.angle_rad) / 2;
  if (angle_rad >= pi_rad || between_rad > 3.1f) return {};
  // The axis turns from the left axis toward the right axis.
  const float turn_rad = angle_rad - left.angle_rad;
  const glm::vec3 across = glm::normalize(right.axis - left.axis * glm::dot(left.axis, right.axis) + glm::vec3{1e-20f});
  return {glm::normalize(left.axis * std::cos(turn_rad) + across * std::sin(turn_rad)), angle_rad + 1e-5f};
}

std::optional<Tree> Tree::build(Mesh& mesh, std::vector<std::uint32_t>& original_faces, const Progress& progress) {
  const std::size_t face_count = mesh.faces.size();
  Items items(face_count);
  for (std::size_t face = 0; face < face_count; ++face) {
    const Face& corners = mesh.faces[face];
    const glm::vec3& a_m = mesh.vertices_m[corners[0]];
    const glm::vec3& b_m = mesh.vertices_m[corners[1]];
    const glm::vec3& c_m = mesh.vertices_m[corners[2]];
    items[face] = {glm::min(glm::min(a_m, b_m), c_m), glm::max(glm::max(a_m, b_m), c_m),
                   static_cast<std::uint32_t>(face)};
  }

  struct Range {
    std::size_t begin, end, depth;
    std::size_t parent;  // set if this is the second child
  };
  constexpr std::size_t no_parent = ~std::size_t{0};
  Tree tree;
  tree.nodes_.reserve(face_count);
  std::vector<Range> waiting;
  if (face_count > 0) waiting.push_back({0, face_count, 0, no_parent});
  std::size_t reported = 0;
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    if (progress && range.begin - reported >= 8192) {
      reported = range.begin;
      if (!progress(static_cast<double>(range.begin) / static_cast<double>(face_count))) return std::nullopt;
    }
    const std::size_t index = tree.nodes_.size();
    if (range.parent != no_parent) tree.nodes_[range.parent].link = static_cast<std::uint32_t>(index);
    Box box;
    const auto begin = items.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto end = items.begin() + static_cast<std::ptrdiff_t>(range.end);
    for (auto item = begin; item != end; ++item) extend(box, item->minimum_m, item->maximum_m);
    Node& node = tree.nodes_.emplace_back();
    node.minimum_m = box.minimum_m;
    node.maximum_m = box.maximum_m;
    const std::size_t count = range.end - range.begin;
    if (count <= leaf_faces_max) {
      node.link = static_cast<std::uint32_t>(range.begin);
      node.face_count = static_cast<std::uint32_t>(count);
      continue;
    }
    node.face_count = 0;
    // From this depth on halves bound the depth for every mesh.
    const auto middle = split(begin, end, range.depth >= depth_max / 2);
    const auto middle_index = static_cast<std::size_t>(middle - items.begin());
    waiting.push_back({middle_index, range.end, range.depth + 1, index});
    waiting.push_back({range.begin, middle_index, range.depth + 1, no_parent});
  }
  tree.nodes_.shrink_to_fit();

  std::vector<Face> faces(face_count);
  original_faces.resize(face_count);
  float largest_m = 0;
  for (std::size_t face = 0; face < face_count; ++face) {
    faces[face] = mesh.faces[items[face].face];
    original_faces[face] = items[face].face;
  }
  mesh.faces = std::move(faces);
  if (!tree.nodes_.empty()) {
    const glm::vec3 corner_m = glm::max(glm::abs(tree.nodes_[0].minimum_m), glm::abs(tree.nodes_[0].maximum_m));
    largest_m = std::max({corner_m.x, corner_m.y, corner_m.z});
  }
  tree.padding_m_ = 1e-6f * largest_m;
  return tree;
}

void Tree::set_cones(const Mesh& mesh, const std::vector<Cone>& face_cones) {
  // Larger nodes are rarely flat.
  constexpr std::uint32_t flat_faces_max = 512;
  struct Part {
    Cone cone;
    std::uint32_t first_face, face_count;
  };
  // Children have higher numbers than their parents.
  std::vector<Part> parts(nodes_.size());
  for (std::size_t index = nodes_.size(); index-- > 0;) {
    Node& node = nodes_[index];
    Part& part = parts[index];
    if (node.face_count > 0) {
      part = {face_cones[node.link], node.link, node.face_count};
      for (std::uint32_t face = 1; face < node.face_count; ++face)
        part.cone = join(part.cone, face_cones[node.link + face]);
    } else {
      const Part& left = parts[index + 1];
      const Part& right = parts[node.link];
      part = {join(left.cone, right.cone), left.first_face, left.face_count + right.face_count};
    }
    if (part.cone.angle_rad < pi_rad) {
      node.axis = part.cone.axis;
      node.cosine = std::cos(part.cone.angle_rad);
      node.sine = std::sin(part.cone.angle_rad);
    }
    if (part.cone.angle_rad >= pi_rad || part.face_count > flat_faces_max) continue;
    node.bottom_m = 1e30f;
    node.top_m = -1e30f;
    float squared_radius_m2 = 0;
    const glm::vec3 middle_m = node.middle_m();
    for (std::uint32_t face = part.first_face; face < part.first_face + part.face_count; ++face)
      for (const std::uint32_t vertex : mesh.faces[face]) {
        const glm::vec3& vertex_m = mesh.vertices_m[vertex];
        const float height_m = glm::dot(node.axis, vertex_m);
        node.bottom_m = std::min(node.bottom_m, height_m);
        node.top_m = std::max(node.top_m, height_m);
        const glm::vec3 across_m = glm::cross(node.axis, vertex_m - middle_m);
        squared_radius_m2 = std::max(squared_radius_m2, glm::dot(across_m, across_m));
      }
    node.radius_m = std::sqrt(squared_radius_m2) * 1.0001f + padding_m_;
  }
}

bool Tree::faces(const glm::vec3& point_m, const Node& node, bool both_sides) {
  if (node.cosine < -0.99f) return true;
  // The directions from the points of the box to the point form a second cone: its sine is radius over distance. Both
  // cones have a common direction if the angle between the axes does not exceed the sum of both angles. All terms are
  // multiplied by the distance.
  const glm::vec3 way_m = point_m - (node.minimum_m + node.maximum_m) * 0.5f;
  const glm::vec3 diagonal_m = (node.maximum_m - node.minimum_m) * 0.5f;
  const float squared_distance_m2 = glm::dot(way_m, way_m);
  const float squared_radius_m2 = glm::dot(diagonal_m, diagonal_m) * 1.001f;
  if (squared_distance_m2 <= squared_radius_m2) return true;
  const float sine_m = std::sqrt(squared_radius_m2);
  const float cosine_m = std::sqrt(squared_distance_m2 - squared_radius_m2);
  if (node.sine * cosine_m + node.cosine * sine_m < 0) return true;  // the sum exceeds 180 degrees
  const float along_m = glm::dot(node.axis, way_m);
  return (both_sides ? std::abs(along_m) : along_m) >= node.cosine * cosine_m - node.sine * sine_m - 1e-3f * cosine_m;
}

}  // namespace inkwell::geometry
