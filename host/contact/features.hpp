// Features of the local model.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "host/contact/placed_object.hpp"
#include "host/contact/step.hpp"

namespace inkwell::contact {

/// A local minimum of the distance from the proxy to the objects.
struct Candidate {
  std::size_t object;  ///< index of the placed object
  std::uint32_t face;  ///< in the order of the tree; 0 for solids
  double distance_m;   ///< from the surface
  glm::dvec3 normal;   ///< from the surface to the proxy, interpolated for smooth objects
  glm::dvec3 point_m;  ///< on the surface
  /// Feature with the radius of the tip. Unset: id, material and motion.
  Feature feature;
};

struct Candidates {
  std::array<Candidate, features_max> nearest;
  std::size_t count = 0;

  std::span<const Candidate> all() const { return {nearest.data(), count}; }
};

/// The nearest local minima with distances up to `radius_m + ahead_m`, nearest first. A minimum behind the plane of a
/// nearer one is omitted.
Candidates find_candidates(std::span<const PlacedObject> objects, const glm::dvec3& proxy_m, double radius_m,
                           double ahead_m);

}  // namespace inkwell::contact
