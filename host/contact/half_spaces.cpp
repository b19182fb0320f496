#include "host/contact/half_spaces.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace inkwell::contact {
namespace {

/// Far below the resolution of the arm, far above the rounding of coordinates.
constexpr double tolerance_m = 1e-10;
constexpr double flattest = 1e-12;

/// Closest point to the goal on the borders of all half-spaces. Returns nothing if the borders are parallel, or if
/// the point is not the closest point of the intersection because a border would have to pull.
std::optional<glm::dvec3> closest_on_borders(const glm::dvec3& goal, std::span<const HalfSpace> borders) {
  const auto missing_m = [&](std::size_t border) { return -borders[border].height_m(goal); };
  const auto cosine = [&](std::size_t left, std::size_t right) {
    return glm::dot(borders[left].normal, borders[right].normal);
  };
  if (borders.size() == 1) {
    if (missing_m(0) < -tolerance_m) return std::nullopt;
    return goal + borders[0].normal * missing_m(0);
  }
  if (borders.size() == 2) {
    const double c = cosine(0, 1);
    const double determinant = 1 - c * c;
    if (determinant < flattest) return std::nullopt;
    const double first = (missing_m(0) - c * missing_m(1)) / determinant;
    const double second = (missing_m(1) - c * missing_m(0)) / determinant;
    if (first < -tolerance_m || second < -tolerance_m) return std::nullopt;
    return goal + borders[0].normal * first + borders[1].normal * second;
  }
  const glm::dvec3 cross_12 = glm::cross(borders[1].normal, borders[2].normal);
  const glm::dvec3 cross_20 = glm::cross(borders[2].normal, borders[0].normal);
  const glm::dvec3 cross_01 = glm::cross(borders[0].normal, borders[1].normal);
  const double determinant = glm::dot(borders[0].normal, cross_12);
  if (determinant * determinant < flattest) return std::nullopt;
  const glm::dvec3 way = (cross_12 * missing_m(0) + cross_20 * missing_m(1) + cross_01 * missing_m(2)) / determinant;
  const double first = glm::dot(way, cross_12) / determinant;
  const double second = glm::dot(way, cross_20) / determinant;
  const double third = glm::dot(way, cross_01) / determinant;
  if (first < -tolerance_m || second < -tolerance_m || third < -tolerance_m) return std::nullopt;
  return goal + way;
}

}  // namespace

double HalfSpace::height_m(const glm::dvec3& x) const { return glm::dot(normal, x) + slack_m; }

bool ClosestPosition::add(const HalfSpace& added) {
  // The new half-space is always active, with up to two of the previous ones.
  constexpr std::size_t none = 3;
  struct Choice {
    std::size_t first, second;
  };
  static constexpr std::array<Choice, 7> choices = {
      {{none, none}, {0, none}, {1, none}, {2, none}, {0, 1}, {0, 2}, {1, 2}}};
  for (const Choice& choice : choices) {
    std::array<HalfSpace, 3> borders{added};
    std::size_t count = 1;
    bool exists = true;
    for (const std::size_t index : {choice.first, choice.second}) {
      if (index == none) continue;
      exists = exists && index < count_;
      borders[count++] = active_[index];
    }
    if (!exists) continue;
    const auto position = closest_on_borders(goal_, {borders.data(), count});
    if (!position) continue;
    bool is_inside = true;
    for (const HalfSpace& other : active()) is_inside = is_inside && other.height_m(*position) >= -tolerance_m;
    if (!is_inside) continue;
    active_ = borders;
    count_ = count;
    position_ = *position;
    return true;
  }
  return false;
}

}  // namespace inkwell::contact
