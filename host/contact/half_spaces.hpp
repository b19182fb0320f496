// Closest point in an intersection of half-spaces.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace inkwell::contact {

/// All x with dot(normal, x) >= -slack_m.
struct HalfSpace {
  glm::dvec3 normal;
  double slack_m;

  double height_m(const glm::dvec3& x) const;
};

/// The half-spaces on whose border the closest point is. Adding a half-space that excludes the current closest point
/// finds the next one; the distance from the goal grows with each.
class ClosestPosition {
 public:
  explicit ClosestPosition(const glm::dvec3& goal) : goal_(goal), position_(goal) {}

  const glm::dvec3& position() const { return position_; }
  std::span<const HalfSpace> active() const { return {active_.data(), count_}; }
  /// Returns false, without a change, if the intersection is empty or its border too flat for the arithmetic.
  bool add(const HalfSpace& added);

 private:
  glm::dvec3 goal_;
  glm::dvec3 position_;
  std::array<HalfSpace, 3> active_{};
  std::size_t count_ = 0;
};

}  // namespace inkwell::contact
