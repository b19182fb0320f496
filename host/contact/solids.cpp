#include "host/contact/solids.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace inkwell::contact {
namespace {

using Kind = SolidPoint::Kind;

constexpr glm::dvec3 along_z{0, 0, 1};

/// Surface at a distance around a point of the solid's skeleton. Directly at the skeleton, each direction is correct.
SolidPoint around(const glm::dvec3& point_m, const glm::dvec3& skeleton_m, const glm::dvec3& substitute, Kind kind,
                  double radius_m) {
  const glm::dvec3 way_m = point_m - skeleton_m;
  const double distance_m = glm::length(way_m);
  const glm::dvec3 normal = distance_m > 1e-12 ? way_m / distance_m : substitute;
  return {distance_m - radius_m, normal, skeleton_m + normal * radius_m, kind, along_z, radius_m};
}

SolidPoint closest(const Sphere& sphere, const glm::dvec3& point_m) {
  return around(point_m, {}, along_z, Kind::sphere, sphere.radius_m);
}

SolidPoint closest(const Capsule& capsule, const glm::dvec3& point_m) {
  const double z_m = std::clamp(point_m.z, -capsule.half_length_m, capsule.half_length_m);
  return around(point_m, {0, 0, z_m}, {1, 0, 0}, z_m == point_m.z ? Kind::cylinder : Kind::sphere, capsule.radius_m);
}

SolidPoint closest(const Plane&, const glm::dvec3& point_m) {
  return {point_m.z, along_z, {point_m.x, point_m.y, 0}, Kind::plane, along_z, 0};
}

SolidPoint closest(const Cylinder& cylinder, const glm::dvec3& point_m) {
  const double from_axis_m = std::hypot(point_m.x, point_m.y);
  const glm::dvec3 radial =
      from_axis_m > 1e-12 ? glm::dvec3{point_m.x, point_m.y, 0} / from_axis_m : glm::dvec3{1, 0, 0};
  const glm::dvec3 cap{0, 0, std::copysign(1.0, point_m.z)};
  const double beyond_side_m = from_axis_m - cylinder.radius_m;
  const double beyond_cap_m = std::abs(point_m.z) - cylinder.half_length_m;
  if (beyond_side_m > 0 && beyond_cap_m > 0) {
    // The tangent of the rim replaces the rim.
    SolidPoint rim = around(point_m, radial * cylinder.radius_m + cap * cylinder.half_length_m, cap, Kind::cylinder, 0);
    rim.axis = glm::cross(cap, radial);
    return rim;
  }
  if (beyond_side_m > beyond_cap_m)
    return {beyond_side_m,  radial,  radial * cylinder.radius_m + along_z * point_m.z,
            Kind::cylinder, along_z, cylinder.radius_m};
  return {beyond_cap_m, cap, {point_m.x, point_m.y, cap.z * cylinder.half_length_m}, Kind::plane, along_z, 0};
}

SolidPoint closest(const Box& box, const glm::dvec3& point_m) {
  const glm::dvec3 beyond_m = glm::abs(point_m) - box.half_size_m;
  const glm::dvec3 outward{std::copysign(1.0, point_m.x), std::copysign(1.0, point_m.y), std::copysign(1.0, point_m.z)};
  const int outside = (beyond_m.x > 0 ? 1 : 0) + (beyond_m.y > 0 ? 1 : 0) + (beyond_m.z > 0 ? 1 : 0);
  if (outside >= 2) {
    const glm::dvec3 corner_m = glm::clamp(point_m, -box.half_size_m, box.half_size_m);
    SolidPoint edge = around(point_m, corner_m, outward, outside == 2 ? Kind::cylinder : Kind::sphere, 0);
    edge.axis = {beyond_m.x > 0 ? 0 : 1, beyond_m.y > 0 ? 0 : 1, beyond_m.z > 0 ? 0 : 1};
    return edge;
  }
  const int axis = beyond_m.x >= beyond_m.y && beyond_m.x >= beyond_m.z ? 0 : beyond_m.y >= beyond_m.z ? 1 : 2;
  glm::dvec3 normal{};
  normal[axis] = outward[axis];
  return {beyond_m[axis], normal, point_m - normal * beyond_m[axis], Kind::plane, along_z, 0};
}

SolidPoint closest(const std::shared_ptr<const geometry::Surface>&, const glm::dvec3& point_m) {
  return {1e6, along_z, point_m, Kind::plane, along_z, 0};
}

}  // namespace

SolidPoint closest_point_of_solid(const Shape& shape, const glm::dvec3& point_m) {
  return std::visit([&](const auto& solid) { return closest(solid, point_m); }, shape);
}

}  // namespace inkwell::contact
