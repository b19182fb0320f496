// Parts of objects that limit a move of the tip.
#pragma once

#include <array>
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

/// The triangles near a point, by object. One search in the trees finds them for several short moves.
struct NearFaces {
  static constexpr double too_many = -1;

  glm::dvec3 center_m{};
  double reach_m = 0;  ///< 0: no search yet; `too_many`: more triangles than the list can hold
  std::size_t count = 0;
  std::array<FaceOfObject, 96> list;  // has no initial values, because they cost time

  void find(std::span<const PlacedObject> objects, const glm::dvec3& center, double reach);
  /// True if the tip cannot touch other triangles during the move.
  bool contain(const Move& move) const;
};

/// The obstacle closest to the start whose half-spaces exclude the end of the move. Nothing if the move is free. The
/// half-spaces `active` protect parts of objects: a tip in such a half-space cannot touch triangles on its other side.
/// If `near` contains the move, no tree is searched.
std::optional<Obstacle> find_obstacle(std::span<const PlacedObject> objects, const NearFaces& near, const Move& move,
                                      std::span<const HalfSpace> active);

/// The same for one face, if its inside is closest to the start.
std::optional<Obstacle> find_obstacle(std::span<const PlacedObject> objects, const Move& move,
                                      const FaceOfObject& face);

/// Largest fraction of the move, 0 to 1, without contact. Every shorter move is without contact too.
double free_fraction(std::span<const PlacedObject> objects, const Move& move, std::span<const HalfSpace> active);

}  // namespace inkwell::contact
