// Distances from solids.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "host/contact/scene.hpp"

namespace inkwell::contact {

/// Closest point of a solid, in the frame of its object.
struct SolidPoint {
  /// Shape of the solid around the closest point, to which the tip's radius is added. An edge is a cylinder and a
  /// corner a sphere, both without radius.
  enum class Kind : std::uint8_t { plane, cylinder, sphere };

  double distance_m;   ///< negative inside
  glm::dvec3 normal;   ///< unit vector, outward
  glm::dvec3 point_m;  ///< on the surface
  Kind kind;
  glm::dvec3 axis;  ///< of the cylinder
  double radius_m;  ///< of the cylinder or sphere
};

/// The shape must be a solid, not a mesh.
SolidPoint closest_point_of_solid(const Shape& shape, const glm::dvec3& point_m);

}  // namespace inkwell::contact
