// Random paths of a hand at bodies with thin walls, ridges and slits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "host/geometry/surface.hpp"

namespace inkwell::contact_trial {

/// A hollow body with a closed wall. The formulas do not use the mesh: they decide whether the tip passed the wall.
struct HollowBody {
  std::string name;
  std::shared_ptr<const geometry::Surface> surface;
  double size_m;                                                     ///< the body is in the cube from -size_m to size_m
  std::function<double(const glm::dvec3&)> distance_from_outside_m;  ///< to the wall, negative beyond the outer surface
  std::function<double(const glm::dvec3&)> distance_from_inside_m;   ///< to the wall, negative beyond the inner surface
};

/// Box, star and comb with walls of at most 0.2 mm, and a ball with a wall of 0.2 mm.
std::vector<HollowBody> hollow_bodies();

struct PathResult {
  bool passed = false;
  double least_clearance_m = 1;  ///< of the tip's surface from the wall
  unsigned touching_steps = 0;
};

inline constexpr unsigned steps_per_path = 200;

/// Moves a hand with up to 2 m/s along path `number`, which decides body, side, tip radius and motion of the body.
PathResult run_path(const std::vector<HollowBody>& bodies, std::uint64_t number);

}  // namespace inkwell::contact_trial
