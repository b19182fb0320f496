#include "host/contact/selection.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace inkwell::contact {
namespace {

/// A surface at this distance from the tip counts as touched.
constexpr double nearly_touched_m = 0.0002;
/// Rounding of a feature. The proxy is not below the feature.
constexpr double rounding_m = 3e-6;
/// Two planes with a smaller angle are one feature (1 degree), and two edges or corners at a smaller distance.
constexpr double same_plane_cosine = 0.99985;
constexpr double same_edge_m = 0.0001;

double height_above_m(const Feature& feature, const glm::dvec3& position_m) {
  const glm::dvec3 direction{feature.direction};
  glm::dvec3 way_m = position_m - glm::dvec3{feature.point_m};
  if (feature.kind == Feature::Kind::plane) return glm::dot(direction, way_m);
  if (feature.kind == Feature::Kind::cylinder) way_m -= direction * glm::dot(direction, way_m);
  return glm::length(way_m) - static_cast<double>(feature.radius_m);
}

bool are_same(const Candidate& left, const Candidate& right) {
  if (left.object != right.object || left.feature.kind != right.feature.kind) return false;
  return left.feature.kind == Feature::Kind::plane ? glm::dot(left.normal, right.normal) > same_plane_cosine
                                                   : glm::distance(left.point_m, right.point_m) < same_edge_m;
}

/// Replaces touched edges and corners by their tangent planes at the proxy.
void flatten(Candidates& candidates, const glm::dvec3& proxy_m, const glm::dvec3& hand_m, double radius_m) {
  for (std::size_t index = 0; index < candidates.count; ++index) {
    const Candidate& candidate = candidates.nearest[index];
    Feature& feature = candidates.nearest[index].feature;
    const double gap_m = candidate.distance_m - radius_m;
    const double depth_m = glm::dot(candidate.normal, proxy_m - hand_m);
    if (feature.kind == Feature::Kind::plane || gap_m > nearly_touched_m ||
        depth_m < static_cast<double>(feature.radius_m))
      continue;
    feature = {.kind = Feature::Kind::plane,
               .direction = glm::vec3{candidate.normal},
               .point_m = glm::vec3{proxy_m - candidate.normal * gap_m}};
  }
}

}  // namespace

Candidates select_features(std::span<const PlacedObject> objects, LimitingFaces limiting, const Pose& pose,
                           const glm::dvec3& proxy_m, double radius_m) {
  const double speed_m_per_s = glm::length(pose.velocity_m_per_s);
  const glm::dvec3 goal_m = pose.position_m + pose.velocity_m_per_s * model_use_s;
  Candidates near = find_candidates(objects, proxy_m, radius_m, look_ahead_m + look_ahead_s * speed_m_per_s);
  flatten(near, proxy_m, goal_m, radius_m);
  // A touching tip would need a second search in most steps, and it meets few other surfaces.
  const bool is_touching = near.count > 0 && near.nearest[0].distance_m < radius_m + nearly_touched_m;
  if (is_touching || speed_m_per_s * model_use_s < look_ahead_m) return near;
  const glm::dvec3 later_m = slide(objects, limiting, proxy_m, goal_m, radius_m);
  if (later_m == goal_m) return near;

  Candidates selected;
  const auto select = [&](const Candidate& candidate) {
    const bool is_known =
        std::ranges::any_of(selected.all(), [&](const Candidate& known) { return are_same(known, candidate); });
    if (!is_known && selected.count < features_max) selected.nearest[selected.count++] = candidate;
  };
  Candidates later = find_candidates(objects, later_m, radius_m, nearly_touched_m);
  flatten(later, later_m, goal_m, radius_m);
  for (Candidate candidate : later.all()) {
    const double height_m = height_above_m(candidate.feature, proxy_m);
    candidate.distance_m = radius_m + height_m;
    if (height_m > -rounding_m) select(candidate);
  }
  for (const Candidate& candidate : near.all()) select(candidate);
  return selected;
}

}  // namespace inkwell::contact
