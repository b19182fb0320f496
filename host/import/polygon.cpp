#include "host/import/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace inkwell::importer {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Twice the area of a triangle; positive if its corners are counter-clockwise.
double doubled_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) { return cross(b - a, c - a); }

/// Projects the polygon on the coordinate plane in which its area is largest. The projection is counter-clockwise.
std::vector<glm::dvec2> projected(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> corners) {
  glm::dvec3 normal(0);
  const glm::dvec3& origin = vertices[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += glm::cross(vertices[corners[i]] - origin, vertices[corners[i + 1]] - origin);
  int axis = 0;
  for (int other = 1; other < 3; ++other)
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  const int right = (axis + 1) % 3, up = (axis + 2) % 3;
  const double sign = normal[axis] < 0 ? -1 : 1;
  std::vector<glm::dvec2> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const glm::dvec3 vertex = vertices[corner] - origin;
    points.emplace_back(vertex[right], sign * vertex[up]);
  }
  return points;
}

/// A polygon without its cut ears.
class Ears {
 public:
  explicit Ears(std::vector<glm::dvec2> points) : points_(std::move(points)) {
    for (std::size_t i = 0; i < points_.size(); ++i) left_.push_back(i);
  }

  std::size_t size() const { return left_.size(); }

  /// Removes the tip of an ear. Returns the positions of its three corners in the original polygon. Without an ear,
  /// which requires crossing edges or corners on a line, removes the corner after the first one.
  std::array<std::size_t, 3> cut() {
    std::size_t found = 1;
    bool is_ear = false;
    for (std::size_t tried = 0; has_ears_ && tried < left_.size(); ++tried) {
      const std::size_t tip = (start_ + tried) % left_.size();
      const auto [a, b, c] = corners_at(tip);
      if (doubled_area(points_[a], points_[b], points_[c]) > 0 && is_empty(tip)) {
        start_ = found = tip;
        is_ear = true;
        break;
      }
    }
    has_ears_ = is_ear;
    const auto ear = corners_at(found);
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(found));
    return ear;
  }

 private:
  std::array<std::size_t, 3> corners_at(std::size_t tip) const {
    const std::size_t count = left_.size();
    return {left_[(tip + count - 1) % count], left_[tip], left_[(tip + 1) % count]};
  }

  bool is_empty(std::size_t tip) const {
    const auto [a, b, c] = corners_at(tip);
    const glm::dvec2 &first = points_[a], &second = points_[b], &third = points_[c];
    return std::ranges::none_of(left_, [&](std::size_t other) {
      const glm::dvec2& point = points_[other];
      if (point == first || point == second || point == third) return false;
      return doubled_area(first, second, point) >= 0 && doubled_area(second, third, point) >= 0 &&
             doubled_area(third, first, point) >= 0;
    });
  }

  std::vector<glm::dvec2> points_;
  std::vector<std::size_t> left_;
  std::size_t start_ = 0;  ///< the search continues at the last ear
  bool has_ears_ = true;
};

}  // namespace

void append_triangles(std::span<const glm::dvec3> vertices, std::span<const std::uint32_t> corners,
                      std::vector<geometry::Face>& faces) {
  if (corners.size() == 3) faces.push_back({corners[0], corners[1], corners[2]});
  if (corners.size() <= 3) return;
  Ears ears(projected(vertices, corners));
  while (ears.size() >= 3) {
    const auto [a, b, c] = ears.cut();
    faces.push_back({corners[a], corners[b], corners[c]});
  }
}

}  // namespace inkwell::importer
