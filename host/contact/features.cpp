#include "host/contact/features.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "host/contact/solids.hpp"

namespace inkwell::contact {
namespace {

using geometry::Region;
using geometry::Surface;

/// Distances that differ by less are equal: covers the rounding of a closest point that two faces share.
constexpr double equal_m = 1e-8;
/// Minima at one point are one minimum.
constexpr double same_point_m = 1e-6;
/// The minimum is behind a plane if its point is deeper than this.
constexpr double behind_m = 2e-6;
/// Faces with a smaller angle form one plane (0.06 degrees).
constexpr double flat_cosine = 0.9999995;
/// Minima of one object with nearly equal normals need only one feature: 1 degree; on a smooth object 15 degrees.
constexpr double alike_cosine = 0.99985;
constexpr double alike_smooth_cosine = 0.966;
/// An edge or corner between faces with smaller angles is sent as a plane (12 degrees), because the next model is
/// there before the plane is wrong by more than a cylinder of the tip's radius.
constexpr double slight_cosine = 0.978;

/// True if no other face at the closest edge or corner is closer to the point.
bool is_local_minimum(const Surface& surface, std::uint32_t face, Region region, const glm::dvec3& point_m,
                      double distance_m) {
  if (region == Region::face) return true;
  const double least_m = std::max(distance_m - equal_m, 0.0);
  const auto is_farther = [&](std::uint32_t other) {
    const glm::dvec3 way_m = geometry::closest_point(point_m, surface.triangle(other)).point_m - point_m;
    return glm::dot(way_m, way_m) >= least_m * least_m;
  };
  if (geometry::is_edge(region)) {
    const geometry::HalfEdge neighbor = surface.adjacency().neighbors[face][geometry::number_of(region)];
    return !geometry::is_face_edge(neighbor) || is_farther(neighbor / 3);
  }
  bool is_minimum = true;
  surface.visit_corner(face, geometry::number_of(region), [&](std::uint32_t other) {
    is_minimum = is_farther(other);
    return is_minimum;
  });
  return is_minimum;
}

glm::dvec3 face_normal(const geometry::Triangle& triangle) {
  const glm::dvec3 normal = glm::cross(triangle.b_m - triangle.a_m, triangle.c_m - triangle.a_m);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::dvec3{};
}

/// Least cosine of the angle between the normal and the faces at the edge or corner; -1 at a border of the mesh.
double least_cosine(const Surface& surface, std::uint32_t face, Region region, const glm::dvec3& normal) {
  const auto cosine = [&](std::uint32_t other) {
    return std::abs(glm::dot(face_normal(surface.triangle(other)), normal));
  };
  if (region == Region::face) return 1;
  double least = cosine(face);
  if (geometry::is_edge(region)) {
    const geometry::HalfEdge neighbor = surface.adjacency().neighbors[face][geometry::number_of(region)];
    return geometry::is_face_edge(neighbor) ? std::min(least, cosine(neighbor / 3)) : -1;
  }
  const unsigned corner = geometry::number_of(region);
  for (const unsigned edge : {corner, (corner + 2) % 3})
    if (!geometry::is_face_edge(surface.adjacency().neighbors[face][edge])) return -1;
  surface.visit_corner(face, corner, [&](std::uint32_t other) {
    least = std::min(least, cosine(other));
    return true;
  });
  return least;
}

Feature plane(const glm::dvec3& normal, const glm::dvec3& point_m) {
  return {.kind = Feature::Kind::plane, .direction = glm::vec3{normal}, .point_m = glm::vec3{point_m}};
}

Feature around_axis(const glm::dvec3& axis, const glm::dvec3& point_m, double radius_m) {
  return {.kind = Feature::Kind::cylinder,
          .direction = glm::vec3{axis},
          .point_m = glm::vec3{point_m},
          .radius_m = static_cast<float>(radius_m)};
}

Feature around_center(const glm::dvec3& normal, const glm::dvec3& center_m, double radius_m) {
  return {.kind = Feature::Kind::sphere,
          .direction = glm::vec3{normal},
          .point_m = glm::vec3{center_m},
          .radius_m = static_cast<float>(radius_m)};
}

/// In the frame of the object.
Feature feature_of_triangle(const Surface& surface, const Object& object, Candidate& candidate, Region region,
                            const glm::dvec3& proxy_m, double radius_m) {
  const std::uint32_t face = candidate.face;
  const glm::dvec3 touch_m = proxy_m - candidate.normal * (candidate.distance_m - radius_m);
  const double cosine = least_cosine(surface, face, region, candidate.normal);
  if (object.is_smooth && cosine >= std::cos(object.crease_rad)) {
    glm::dvec3 normal = surface.smooth_normal(face, candidate.point_m, object.crease_rad);
    if (glm::dot(normal, candidate.normal) < 0) normal = -normal;
    if (normal != glm::dvec3{}) candidate.normal = normal;
    return plane(candidate.normal, touch_m);
  }
  if (cosine >= flat_cosine) {
    const glm::dvec3 normal = face_normal(surface.triangle(face));
    if (normal != glm::dvec3{}) candidate.normal = glm::dot(normal, candidate.normal) < 0 ? -normal : normal;
    return plane(candidate.normal, touch_m);
  }
  if (cosine >= slight_cosine) return plane(candidate.normal, touch_m);
  if (geometry::is_edge(region)) {
    const geometry::Triangle triangle = surface.triangle(face);
    const glm::dvec3 corners_m[] = {triangle.a_m, triangle.b_m, triangle.c_m};
    const unsigned edge = geometry::number_of(region);
    const glm::dvec3 along = corners_m[(edge + 1) % 3] - corners_m[edge];
    return around_axis(glm::normalize(along), candidate.point_m, radius_m);
  }
  return around_center(candidate.normal, candidate.point_m, radius_m);
}

Feature feature_of_solid(const SolidPoint& point, const glm::dvec3& proxy_m, double radius_m) {
  const double offset_m = point.radius_m + radius_m;
  const glm::dvec3 center_m = point.point_m - point.normal * point.radius_m;
  if (point.kind == SolidPoint::Kind::plane || offset_m > static_cast<double>(feature_radius_max_m))
    return plane(point.normal, proxy_m - point.normal * (point.distance_m - radius_m));
  return point.kind == SolidPoint::Kind::cylinder ? around_axis(point.axis, center_m, offset_m)
                                                  : around_center(point.normal, center_m, offset_m);
}

void to_workspace(Candidate& candidate, const PlacedObject& placed) {
  candidate.normal = placed.rotation * candidate.normal;
  candidate.point_m = placed.to_workspace(candidate.point_m);
  candidate.feature.direction = glm::vec3{placed.rotation * glm::dvec3{candidate.feature.direction}};
  candidate.feature.point_m = glm::vec3{placed.to_workspace(glm::dvec3{candidate.feature.point_m})};
}

/// A local minimum before its feature is made, in the frame of its object.
struct Minimum {
  std::size_t object;
  std::uint32_t face;
  Region region;
  double distance_m;
  glm::dvec3 normal, point_m;  // in the frame of the object
  glm::dvec3 workspace_normal, workspace_point_m;
};

/// The nearest minima, sorted. It has room for more minima than the model has features, because some are omitted.
class Minima {
 public:
  static constexpr std::size_t capacity = 12;

  double limit_m() const { return count_ == capacity ? minima_[capacity - 1].distance_m : 1e6; }

  void add(const Minimum& minimum) {
    if (minimum.distance_m >= limit_m()) return;
    const auto end = minima_.begin() + static_cast<std::ptrdiff_t>(count_);
    const bool is_known = std::any_of(minima_.begin(), end, [&](const Minimum& other) {
      return glm::distance(other.workspace_point_m, minimum.workspace_point_m) < same_point_m;
    });
    if (is_known) return;
    if (count_ < capacity) ++count_;
    std::size_t index = count_ - 1;
    for (; index > 0 && minima_[index - 1].distance_m > minimum.distance_m; --index)
      minima_[index] = minima_[index - 1];
    minima_[index] = minimum;
  }

  std::span<const Minimum> all() const { return {minima_.data(), count_}; }

 private:
  std::array<Minimum, capacity> minima_;
  std::size_t count_ = 0;
};

void add_minima(Minima& minima, std::size_t index, const PlacedObject& placed, const glm::dvec3& proxy_m,
                double radius_m) {
  const glm::dvec3 local_m = placed.to_object(proxy_m);
  const auto add = [&](Minimum minimum) {
    minimum.object = index;
    minimum.workspace_normal = placed.rotation * minimum.normal;
    minimum.workspace_point_m = placed.to_workspace(minimum.point_m);
    minima.add(minimum);
  };
  if (!placed.surface) {
    const SolidPoint point = closest_point_of_solid(placed.object->shape, local_m);
    if (point.distance_m <= radius_m) add({0, 0, Region::face, point.distance_m, point.normal, point.point_m, {}, {}});
    return;
  }
  const Surface& surface = *placed.surface;
  const double reach_m = radius_m + static_cast<double>(surface.radius_m());
  if (glm::dot(local_m, local_m) > reach_m * reach_m) return;
  const bool both_sides = !surface.is_solid();
  surface.tree().visit_facing(glm::vec3{local_m}, static_cast<float>(radius_m), both_sides, [&](std::uint32_t face) {
    const geometry::Triangle triangle = surface.triangle(face);
    const geometry::ClosestPoint closest = geometry::closest_point(local_m, triangle);
    const glm::dvec3 way_m = local_m - closest.point_m;
    const double squared_m2 = glm::dot(way_m, way_m);
    const double limit_m = std::min(radius_m, minima.limit_m());
    if (squared_m2 > limit_m * limit_m || squared_m2 == 0) return;
    // The back of a face of a solid is not felt.
    if (closest.region == Region::face && !both_sides &&
        glm::dot(way_m, glm::cross(triangle.b_m - triangle.a_m, triangle.c_m - triangle.a_m)) < 0)
      return;
    const double distance_m = std::sqrt(squared_m2);
    if (!is_local_minimum(surface, face, closest.region, local_m, distance_m)) return;
    add({0, face, closest.region, distance_m, way_m / distance_m, closest.point_m, {}, {}});
  });
}

}  // namespace

Candidates find_candidates(std::span<const PlacedObject> objects, const glm::dvec3& proxy_m, double radius_m,
                           double ahead_m) {
  Minima minima;
  for (std::size_t index = 0; index < objects.size(); ++index)
    if (objects[index].is_felt) add_minima(minima, index, objects[index], proxy_m, radius_m + ahead_m);

  Candidates candidates;
  for (const Minimum& minimum : minima.all()) {
    if (candidates.count == features_max) break;
    const PlacedObject& placed = objects[minimum.object];
    const double alike = placed.object->is_smooth ? alike_smooth_cosine : alike_cosine;
    const bool is_needless = std::ranges::any_of(candidates.all(), [&](const Candidate& nearer) {
      if (nearer.object == minimum.object && glm::dot(nearer.normal, minimum.workspace_normal) > alike) return true;
      return nearer.feature.kind == Feature::Kind::plane &&
             glm::dot(nearer.normal, minimum.workspace_point_m - nearer.point_m) < -behind_m;
    });
    if (is_needless) continue;
    Candidate& candidate = candidates.nearest[candidates.count++];
    candidate = {minimum.object, minimum.face, minimum.distance_m, minimum.normal, minimum.point_m, {}};
    const glm::dvec3 local_m = placed.to_object(proxy_m);
    candidate.feature =
        placed.surface
            ? feature_of_triangle(*placed.surface, *placed.object, candidate, minimum.region, local_m, radius_m)
            : feature_of_solid(closest_point_of_solid(placed.object->shape, local_m), local_m, radius_m);
    to_workspace(candidate, placed);
  }
  return candidates;
}

}  // namespace inkwell::contact
