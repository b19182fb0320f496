#include "host/contact/slide.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "host/contact/half_spaces.hpp"
#include "host/contact/obstacles.hpp"

namespace inkwell::contact {
namespace {

/// A shorter move is the last.
constexpr double still_m = 3e-6;
constexpr int moves_max = 24;
constexpr int searches_max = 30;
constexpr int obstacles_max = 12;
/// Longest move for which a list of the near faces is made. Usually the following, shorter moves need no other list.
constexpr double listed_way_m = 0.0005;
constexpr double listed_margin_m = 0.00005;

/// The move from `start_m` that ends closest to `goal_m` in the half-spaces of all obstacles.
glm::dvec3 find_way_m(std::span<const PlacedObject> objects, NearFaces& near, LimitingFaces& limiting,
                      const glm::dvec3& start_m, const glm::dvec3& goal_m, double radius_m, bool recovers,
                      int& searches) {
  ClosestPosition closest(goal_m - start_m);
  const LimitingFaces known = limiting;
  limiting.count = 0;
  const auto add = [&](const Obstacle& obstacle) {
    if (limiting.count < limiting.faces.size()) limiting.faces[limiting.count++] = obstacle.face;
    return closest.add(obstacle.space);
  };
  bool is_possible = true;
  for (std::size_t index = 0; index < known.count; ++index) {
    const auto obstacle = find_obstacle(objects, {start_m, closest.position(), radius_m, recovers}, known.faces[index]);
    if (obstacle) is_possible = is_possible && add(*obstacle);
  }
  for (int count = 0; count < obstacles_max && is_possible; ++count) {
    const Move move{start_m, closest.position(), radius_m, recovers};
    const double way_m = glm::length(move.way_m);
    if (way_m < listed_way_m && near.reach_m != NearFaces::too_many && !near.contain(move))
      near.find(objects, start_m, radius_m + 1.2 * way_m + listed_margin_m);
    const auto obstacle = find_obstacle(objects, near, move, closest.active());
    ++searches;
    if (!obstacle) return closest.position();
    is_possible = add(*obstacle);
  }
  // A tip that overlaps two opposite faces cannot be pushed out of both.
  if (!is_possible && recovers) return find_way_m(objects, near, limiting, start_m, goal_m, radius_m, false, searches);
  // Too many obstacles: a part of the last move is possible.
  const Move move{start_m, closest.position(), radius_m, false};
  return move.way_m * free_fraction(objects, move, closest.active());
}

}  // namespace

glm::dvec3 slide(std::span<const PlacedObject> objects, LimitingFaces& limiting, const glm::dvec3& start_m,
                 const glm::dvec3& goal_m, double radius_m) {
  glm::dvec3 position_m = start_m;
  NearFaces near;
  int searches = 0;
  for (int count = 0; count < moves_max && searches < searches_max; ++count) {
    const glm::dvec3 way_m = find_way_m(objects, near, limiting, position_m, goal_m, radius_m + skin_m, true, searches);
    position_m += way_m;
    if (position_m == goal_m || glm::dot(way_m, way_m) < still_m * still_m) break;
  }
  return position_m;
}

}  // namespace inkwell::contact
