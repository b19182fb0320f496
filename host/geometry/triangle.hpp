// Closest points of triangles.
#pragma once

#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace inkwell::geometry {

/// Part of a triangle that contains the closest point. Edge 0 leads from corner 0 to corner 1.
enum class Region : std::uint8_t { corner_0, corner_1, corner_2, edge_0, edge_1, edge_2, face };

constexpr bool is_corner(Region region) { return region <= Region::corner_2; }
constexpr bool is_edge(Region region) { return region >= Region::edge_0 && region <= Region::edge_2; }
/// Number of the corner or of the edge: 0 to 2; 3 for the face.
constexpr unsigned number_of(Region region) {
  return static_cast<unsigned>(region) % 3 + (region == Region::face ? 3 : 0);
}

struct Triangle {
  glm::dvec3 a_m, b_m, c_m;
};

struct ClosestPoint {
  glm::dvec3 point_m;
  Region region;
};

/// Closest point of the segment from `a_m` to `b_m`, which may have equal ends. The regions are corner 0, corner 1 and
/// edge 0.
inline ClosestPoint closest_point_of_segment(const glm::dvec3& point_m, const glm::dvec3& a_m, const glm::dvec3& b_m) {
  const glm::dvec3 along = b_m - a_m;
  const double part = glm::dot(point_m - a_m, along);
  const double whole = glm::dot(along, along);
  if (part <= 0) return {a_m, Region::corner_0};
  if (part >= whole) return {b_m, Region::corner_1};
  return {a_m + along * (part / whole), Region::edge_0};
}

/// Closest point of a triangle without area.
inline ClosestPoint closest_point_of_edges(const glm::dvec3& point_m, const Triangle& triangle) {
  const glm::dvec3* const corners_m[] = {&triangle.a_m, &triangle.b_m, &triangle.c_m};
  ClosestPoint closest{};
  double least = 1e300;
  for (unsigned edge = 0; edge < 3; ++edge) {
    ClosestPoint candidate = closest_point_of_segment(point_m, *corners_m[edge], *corners_m[(edge + 1) % 3]);
    const glm::dvec3 way_m = candidate.point_m - point_m;
    if (!(glm::dot(way_m, way_m) < least)) continue;
    least = glm::dot(way_m, way_m);
    const unsigned first = candidate.region == Region::edge_0 ? 3 + edge : (edge + number_of(candidate.region)) % 3;
    closest = {candidate.point_m, static_cast<Region>(first)};
  }
  return closest;
}

/// Closest point of a triangle, from the signs of the barycentric coordinates (Ericson, Real-Time Collision Detection,
/// section 5.1.5).
inline ClosestPoint closest_point(const glm::dvec3& point_m, const Triangle& triangle) {
  const auto& [a_m, b_m, c_m] = triangle;
  const glm::dvec3 ab = b_m - a_m;
  const glm::dvec3 ac = c_m - a_m;
  const glm::dvec3 ap = point_m - a_m;
  const double ab_ap = glm::dot(ab, ap);
  const double ac_ap = glm::dot(ac, ap);
  if (ab_ap <= 0 && ac_ap <= 0) return {a_m, Region::corner_0};

  const glm::dvec3 bp = point_m - b_m;
  const double ab_bp = glm::dot(ab, bp);
  const double ac_bp = glm::dot(ac, bp);
  if (ab_bp >= 0 && ac_bp <= ab_bp) return {b_m, Region::corner_1};

  const double weight_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (weight_c <= 0 && ab_ap > 0 && ab_bp < 0) return {a_m + ab * (ab_ap / (ab_ap - ab_bp)), Region::edge_0};

  const glm::dvec3 cp = point_m - c_m;
  const double ab_cp = glm::dot(ab, cp);
  const double ac_cp = glm::dot(ac, cp);
  if (ac_cp >= 0 && ab_cp <= ac_cp) return {c_m, Region::corner_2};

  const double weight_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (weight_b <= 0 && ac_ap > 0 && ac_cp < 0) return {a_m + ac * (ac_ap / (ac_ap - ac_cp)), Region::edge_2};

  const double weight_a = ab_bp * ac_cp - ab_cp * ac_bp;
  const double from_b = ac_bp - ab_bp;
  const double from_c = ab_cp - ac_cp;
  if (weight_a <= 0 && from_b > 0 && from_c > 0)
    return {b_m + (c_m - b_m) * (from_b / (from_b + from_c)), Region::edge_1};

  // The sum is the square of twice the area.
  const double sum = weight_a + weight_b + weight_c;
  if (!(sum > 1e-14 * glm::dot(ab, ab) * glm::dot(ac, ac))) return closest_point_of_edges(point_m, triangle);
  return {a_m + ab * (weight_b / sum) + ac * (weight_c / sum), Region::face};
}

}  // namespace inkwell::geometry
