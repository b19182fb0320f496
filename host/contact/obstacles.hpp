// Parts of objects that limit a move of the tip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "host/contact/half_spaces.hpp"
#include "host/contact/placed_object.hpp"

namespace inkwell::contact {

/// Shortest move that matters, and largest violation of a half-space.
inline constexpr double resolution_m = 2e-8;

/// A straight move of the center of the tip.
struct Move {
  glm::dvec3 start_m;
  glm::dvec3 way_m;
  double radius_m;  ///< distance to keep from surfaces
  /// A tip that is too close to a surface is pushed outward. Otherwise it only does not get closer.
  bool recovers;
};

/// A triangle or solid with a half-space in which the center of the tip cannot touch it. The half-space contains the
/// start of the move and is relative to the start.
struct Obstacle {
  FaceOfObject face;
  double distance_m;  ///< from the start of the move
  HalfSpace space;
};

/// The obstacle closest to the start whose half-spaces exclude the end of the move. Nothing if the move is free. The
/// half-spaces `active` protect parts of objects: a tip in such a half-space cannot touch triangles on its other side.
std::optional<Obstacle> find_obstacle(std::span<const PlacedObject> objects, const Move& move,
                                      std::span<const HalfSpace> active);

/// The same for one face, if its inside is closest to the start.
std::optional<Obstacle> find_obstacle(std::span<const PlacedObject> objects, const Move& move,
                                      const FaceOfObject& face);

/// Largest fraction of the move, 0 to 1, without contact. Every shorter move is without contact too.
double free_fraction(std::span<const PlacedObject> objects, const Move& move, std::span<const HalfSpace> active);

}  // namespace inkwell::contact
