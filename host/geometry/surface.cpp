#include "host/geometry/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace inkwell::geometry {
namespace {

/// Fractions of the whole work, measured with 327,680 faces.
constexpr double tree_start = 0.05;
constexpr double tree_end = 0.6;

glm::dvec3 normalized_or_zero(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return length > 0 ? vector / length : glm::dvec3{};
}

glm::dvec3 unit_normal(const Triangle& triangle) {
  return normalized_or_zero(glm::cross(triangle.b_m - triangle.a_m, triangle.c_m - triangle.a_m));
}

double corner_angle_rad(const Triangle& triangle, unsigned corner) {
  const glm::dvec3* const corners_m[] = {&triangle.a_m, &triangle.b_m, &triangle.c_m};
  const glm::dvec3 left = *corners_m[(corner + 1) % 3] - *corners_m[corner];
  const glm::dvec3 right = *corners_m[(corner + 2) % 3] - *corners_m[corner];
  return std::atan2(glm::length(glm::cross(left, right)), glm::dot(left, right));
}

/// Renumbers the vertices in the order of their first face, so that close faces have close vertices in memory.
void reorder_vertices(Mesh& mesh) {
  constexpr std::uint32_t unused = 0xFFFFFFFF;
  std::vector<std::uint32_t> numbers(mesh.vertices_m.size(), unused);
  std::vector<glm::vec3> vertices_m;
  vertices_m.reserve(mesh.vertices_m.size());
  for (Face& face : mesh.faces)
    for (std::uint32_t& corner : face) {
      std::uint32_t& number = numbers[corner];
      if (number == unused) {
        number = static_cast<std::uint32_t>(vertices_m.size());
        vertices_m.push_back(mesh.vertices_m[corner]);
      }
      corner = number;
    }
  mesh.vertices_m = std::move(vertices_m);
}

/// For each face a cone that contains the normals of all faces at its three corners. The cone is complete at borders
/// and where faces have opposite orientations.
std::vector<Cone> make_face_cones(const Mesh& mesh, const Adjacency& adjacency) {
  struct Normals {
    glm::vec3 sum{};
    float least_cosine = 1;
  };
  std::vector<Normals> at_vertex(mesh.vertices_m.size());
  std::vector<glm::vec3> normals(mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const glm::vec3 normal = area_normal_m2(mesh, mesh.faces[face]);
    const float length = glm::length(normal);
    normals[face] = length > 0 ? normal / length : glm::vec3{};
    for (std::size_t corner = 0; corner < 3; ++corner) at_vertex[mesh.faces[face][corner]].sum += normals[face];
  }
  for (Normals& vertex : at_vertex) {
    const float length = glm::length(vertex.sum);
    vertex.sum = length > 1e-3f ? vertex.sum / length : glm::vec3{};
    if (!(length > 1e-3f)) vertex.least_cosine = -1;
  }
  for (std::size_t face = 0; face < mesh.faces.size(); ++face)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Normals& vertex = at_vertex[mesh.faces[face][corner]];
      vertex.least_cosine = std::min(vertex.least_cosine, glm::dot(vertex.sum, normals[face]));
      const HalfEdge edge = static_cast<HalfEdge>(3 * face + corner);
      if (is_face_edge(adjacency.across(edge)) && !is_flipped(mesh, adjacency, edge)) continue;
      vertex.least_cosine = -1;
      at_vertex[mesh.faces[face][(corner + 1) % 3]].least_cosine = -1;
    }
  std::vector<Cone> cones(mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Normals& vertex = at_vertex[mesh.faces[face][corner]];
      // A vertex with normals in more than half a sphere can have a local minimum in each direction.
      const Cone cone = vertex.least_cosine > 0.1f
                            ? Cone{vertex.sum, std::acos(std::min(vertex.least_cosine, 1.0f)) + 1e-3f}
                            : Cone{};
      cones[face] = corner == 0 ? cone : join(cones[face], cone);
    }
  }
  return cones;
}

double volume_of_m3(const Mesh& mesh) {
  double six_fold_m3 = 0;
  for (const Face& face : mesh.faces)
    six_fold_m3 += glm::dot(glm::dvec3{mesh.vertices_m[face[0]]},
                            glm::cross(glm::dvec3{mesh.vertices_m[face[1]]}, glm::dvec3{mesh.vertices_m[face[2]]}));
  return six_fold_m3 / 6;
}

bool is_oriented(const Mesh& mesh, const Adjacency& adjacency) {
  for (HalfEdge edge = 0; edge < 3 * mesh.faces.size(); ++edge)
    if (is_flipped(mesh, adjacency, edge)) return false;
  return true;
}

template <class Element>
std::size_t bytes(const std::vector<Element>& elements) {
  return elements.capacity() * sizeof(Element);
}

}  // namespace

std::shared_ptr<const Surface> Surface::build(Mesh mesh, const Progress& progress,
                                              std::span<const std::uint32_t> sources) {
  const auto proceeds = [&](double fraction) { return !progress || progress(fraction); };
  if (!proceeds(0)) return nullptr;
  const std::shared_ptr<Surface> surface(new Surface);
  const Box box = bounding_box(mesh);
  if (!mesh.vertices_m.empty()) {
    surface->middle_m_ = (glm::dvec3{box.minimum_m} + glm::dvec3{box.maximum_m}) * 0.5;
    surface->radius_m_ = static_cast<float>(glm::length(glm::dvec3{box.maximum_m} - surface->middle_m_) * 1.000001);
  }
  for (glm::vec3& vertex_m : mesh.vertices_m) vertex_m = glm::vec3{glm::dvec3{vertex_m} - surface->middle_m_};
  if (!proceeds(tree_start)) return nullptr;
  auto tree = Tree::build(mesh, surface->original_faces_,
                          [&](double fraction) { return proceeds(tree_start + (tree_end - tree_start) * fraction); });
  if (!tree) return nullptr;
  surface->tree_ = std::move(*tree);
  if (!sources.empty())
    for (std::uint32_t& face : surface->original_faces_) face = sources[face];
  reorder_vertices(mesh);
  surface->mesh_ = std::move(mesh);
  if (!proceeds(tree_end)) return nullptr;
  surface->adjacency_ = find_neighbors(surface->mesh_);
  if (!proceeds(0.8)) return nullptr;
  surface->tree_.set_cones(surface->mesh_, make_face_cones(surface->mesh_, surface->adjacency_));
  surface->volume_m3_ = volume_of_m3(surface->mesh_);
  surface->is_solid_ =
      surface->volume_m3_ > 0 && is_closed(surface->adjacency_) && is_oriented(surface->mesh_, surface->adjacency_);
  if (!proceeds(1)) return nullptr;
  return surface;
}

std::optional<SurfacePoint> Surface::closest(const glm::dvec3& point_m, double radius_m, std::uint32_t start) const {
  std::optional<SurfacePoint> closest;
  double least_m2 = radius_m * radius_m;
  const auto try_face = [&](std::uint32_t face) {
    const ClosestPoint candidate = closest_point(point_m, triangle(face));
    const glm::dvec3 way_m = candidate.point_m - point_m;
    const double squared_m2 = glm::dot(way_m, way_m);
    if (squared_m2 > least_m2 || (closest && squared_m2 == least_m2)) return;
    least_m2 = squared_m2;
    closest = {face, candidate.point_m, candidate.region, 0};
  };
  if (start < mesh_.faces.size()) try_face(start);
  auto search_radius_m = static_cast<float>(std::min(std::sqrt(least_m2), 1e6));
  const auto enters = [](const Tree::Node&) { return true; };
  tree_.visit_closest_if(glm::vec3{point_m}, search_radius_m, enters, [&](std::uint32_t face, float& radius) {
    const double before_m2 = least_m2;
    try_face(face);
    if (least_m2 < before_m2) radius = static_cast<float>(std::sqrt(least_m2));
  });
  if (closest) closest->distance_m = std::sqrt(least_m2);
  return closest;
}

std::optional<SurfacePoint> Surface::first_hit(const glm::dvec3& from_m, const glm::dvec3& to_m) const {
  constexpr double widening = 1e-6;
  std::optional<SurfacePoint> hit;
  const glm::dvec3 way_m = to_m - from_m;
  const double length_m = glm::length(way_m);
  double end = 1;
  const glm::dvec3 inverse = 1.0 / way_m;  // infinite along some axes
  const double padding_m = 1e-6 * (static_cast<double>(radius_m_) + glm::length(from_m));
  const auto enters = [&](const Tree::Node& node) {
    double first = 0;
    double last = end;
    for (int axis = 0; axis < 3; ++axis) {
      const double low_m = static_cast<double>(node.minimum_m[axis]) - padding_m - from_m[axis];
      const double high_m = static_cast<double>(node.maximum_m[axis]) + padding_m - from_m[axis];
      if (way_m[axis] == 0) {
        if (low_m > 0 || high_m < 0) return false;
        continue;
      }
      const auto [near, far] = std::minmax(low_m * inverse[axis], high_m * inverse[axis]);
      first = std::max(first, near);
      last = std::min(last, far);
    }
    return first <= last;
  };
  tree_.visit_if(enters, [&](std::uint32_t face) {
    const Triangle corners = triangle(face);
    const glm::dvec3 normal = glm::cross(corners.b_m - corners.a_m, corners.c_m - corners.a_m);
    const double squared_area = glm::dot(normal, normal);
    const double along = glm::dot(normal, way_m);
    if (squared_area == 0 || along == 0) return;
    const double part = glm::dot(normal, corners.a_m - from_m) / along;
    if (!(part >= 0 && part <= end)) return;
    const glm::dvec3 point_m = from_m + way_m * part;
    const double weight_a = glm::dot(normal, glm::cross(corners.b_m - point_m, corners.c_m - point_m));
    const double weight_b = glm::dot(normal, glm::cross(corners.c_m - point_m, corners.a_m - point_m));
    const double weight_c = glm::dot(normal, glm::cross(corners.a_m - point_m, corners.b_m - point_m));
    if (std::min({weight_a, weight_b, weight_c}) < -widening * squared_area) return;
    end = part;
    hit = {face, point_m, Region::face, part * length_m};
  });
  return hit;
}

bool Surface::contains(const glm::dvec3& point_m) const {
  if (!is_solid_ || glm::length(point_m) > static_cast<double>(radius_m_)) return false;
  const auto nearest = closest(point_m, 1e6);
  if (!nearest) return false;
  return glm::dot(feature_normal(nearest->face, nearest->region), point_m - nearest->point_m) < 0;
}

glm::dvec3 Surface::feature_normal(std::uint32_t face, Region region, double crease_rad) const {
  const glm::dvec3 own = unit_normal(triangle(face));
  if (region == Region::face) return own;
  const double least_cosine = crease_rad < 3 ? std::cos(crease_rad) : -2;
  const bool has_direction = own != glm::dvec3{};
  if (is_edge(region)) {
    const HalfEdge neighbor = adjacency_.neighbors[face][number_of(region)];
    if (!is_face_edge(neighbor)) return own;
    glm::dvec3 other = unit_normal(triangle(neighbor / 3));
    if (is_flipped(mesh_, adjacency_, neighbor)) other = -other;
    return glm::dot(own, other) >= least_cosine ? normalized_or_zero(own + other) : own;
  }
  const unsigned corner = number_of(region);
  const std::uint32_t vertex = mesh_.faces[face][corner];
  glm::dvec3 sum{};
  visit_corner(face, corner, [&](std::uint32_t neighbor) {
    const Triangle corners = triangle(neighbor);
    const glm::dvec3 normal = unit_normal(corners);
    if (!has_direction || glm::dot(own, normal) >= least_cosine)
      sum += normal * corner_angle_rad(corners, corner_with(mesh_.faces[neighbor], vertex));
    return true;
  });
  return normalized_or_zero(sum);
}

glm::dvec3 Surface::smooth_normal(std::uint32_t face, const glm::dvec3& point_m, double crease_rad) const {
  const Triangle corners = triangle(face);
  const glm::dvec3 normal = glm::cross(corners.b_m - corners.a_m, corners.c_m - corners.a_m);
  const double squared_area = glm::dot(normal, normal);
  if (squared_area == 0) return normal;
  const double weight_b = glm::dot(normal, glm::cross(corners.c_m - point_m, corners.a_m - point_m)) / squared_area;
  const double weight_c = glm::dot(normal, glm::cross(corners.a_m - point_m, corners.b_m - point_m)) / squared_area;
  return normalized_or_zero(feature_normal(face, Region::corner_0, crease_rad) * (1 - weight_b - weight_c) +
                            feature_normal(face, Region::corner_1, crease_rad) * weight_b +
                            feature_normal(face, Region::corner_2, crease_rad) * weight_c);
}

std::size_t Surface::memory_bytes() const {
  return sizeof(*this) + bytes(mesh_.vertices_m) + bytes(mesh_.faces) + bytes(adjacency_.neighbors) +
         tree_.memory_bytes() + bytes(original_faces_);
}

}  // namespace inkwell::geometry
