// Motion of the tip without passing surfaces.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "host/contact/placed_object.hpp"

namespace inkwell::contact {

/// The tip stays away from surfaces by its radius plus this distance, which covers rounding.
inline constexpr double skin_m = 1e-6;

/// The faces that limited the last move. Starting with these faces saves a search.
struct LimitingFaces {
  std::array<FaceOfObject, 3> faces;
  std::size_t count = 0;
};

/// Moves the center of a tip from `start_m` toward `goal_m` as far as the distance from the goal decreases. The tip
/// keeps its radius from all felt objects along the whole path. A tip that overlaps an object at the start does not
/// get closer to its surface and is pushed outward slowly. `limiting` may have any faces of the objects.
glm::dvec3 slide(std::span<const PlacedObject> objects, LimitingFaces& limiting, const glm::dvec3& start_m,
                 const glm::dvec3& goal_m, double radius_m);

}  // namespace inkwell::contact
