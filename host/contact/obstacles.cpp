#include "host/contact/obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "host/contact/solids.hpp"

namespace inkwell::contact {
namespace {

using geometry::Tree;

/// A half-space protects a triangle if no corner rises above the border by more than this.
constexpr double protection_m = 2e-7;
/// Largest outward move of an overlapping tip.
constexpr double recovery_m = 1e-5;
/// Obstacles are equally close if their distances differ by less. Of these the most violated one is found, so that
/// few obstacles are needed where the tip touches many faces.
constexpr double equally_close_m = 1e-7;

/// Fraction of the way that the half-space permits.
double permitted(const HalfSpace& space, const glm::dvec3& way_m) {
  const double along_m = glm::dot(space.normal, way_m);
  const double slack_m = std::max(space.slack_m, 0.0) + resolution_m;
  return along_m >= -slack_m ? 1 : slack_m / -along_m;
}

/// All points at least the tip's radius below this plane are protected.
struct Protection {
  glm::dvec3 normal;
  double border_m;
};

/// A move in the frame of an object.
struct LocalMove {
  Move move;
  std::array<Protection, 3> protections;
  std::size_t protection_count = 0;
  // Box around the tip's path. A tree has single precision, so the box and the borders are widened by `padding_m`.
  glm::vec3 minimum_m, maximum_m;
  std::array<glm::vec3, 3> normals;
  std::array<float, 3> borders_m;

  LocalMove(const PlacedObject& placed, const Move& in_workspace, std::span<const HalfSpace> active)
      : move(in_workspace) {
    move.start_m = placed.to_object(in_workspace.start_m);
    move.way_m = placed.turned_to_object(in_workspace.way_m);
    const float padding_m = placed.surface->tree().padding_m() + 1e-6f * static_cast<float>(move.radius_m);
    const glm::vec3 margin_m{static_cast<float>(move.radius_m) + padding_m};
    const glm::vec3 start_m{move.start_m};
    const glm::vec3 end_m{move.start_m + move.way_m};
    minimum_m = glm::min(start_m, end_m) - margin_m;
    maximum_m = glm::max(start_m, end_m) + margin_m;
    for (const HalfSpace& space : active) {
      const glm::dvec3 normal = placed.turned_to_object(space.normal);
      const double border_m = glm::dot(normal, move.start_m) - space.slack_m - move.radius_m + protection_m;
      protections[protection_count] = {normal, border_m};
      normals[protection_count] = glm::vec3{normal};
      borders_m[protection_count] = static_cast<float>(border_m) - padding_m;
      ++protection_count;
    }
  }

  /// False if the tip cannot touch anything in the box of the node.
  bool concerns(const Tree::Node& node) const {
    if (node.minimum_m.x > maximum_m.x || node.maximum_m.x < minimum_m.x || node.minimum_m.y > maximum_m.y ||
        node.maximum_m.y < minimum_m.y || node.minimum_m.z > maximum_m.z || node.maximum_m.z < minimum_m.z)
      return false;
    for (std::size_t index = 0; index < protection_count; ++index) {
      const glm::vec3& normal = normals[index];
      const float highest_m = std::max(normal.x * node.minimum_m.x, normal.x * node.maximum_m.x) +
                              std::max(normal.y * node.minimum_m.y, normal.y * node.maximum_m.y) +
                              std::max(normal.z * node.minimum_m.z, normal.z * node.maximum_m.z);
      if (highest_m < borders_m[index]) return false;
      if (!node.has_cylinder()) continue;
      const float cosine = glm::dot(normal, node.axis);
      const glm::vec3 across = normal - node.axis * cosine;
      const float cylinder_highest_m = std::max(cosine * node.bottom_m, cosine * node.top_m) +
                                       glm::dot(across, node.middle_m()) + glm::length(across) * node.radius_m;
      if (cylinder_highest_m < borders_m[index]) return false;
    }
    return true;
  }

  bool is_protected(const geometry::Triangle& triangle) const {
    for (std::size_t index = 0; index < protection_count; ++index) {
      const auto& [normal, border_m] = protections[index];
      if (glm::dot(normal, triangle.a_m) <= border_m && glm::dot(normal, triangle.b_m) <= border_m &&
          glm::dot(normal, triangle.c_m) <= border_m)
        return true;
    }
    return false;
  }
};

double limited_slack_m(double distance_m, const Move& move) {
  return std::max(distance_m - move.radius_m, move.recovers ? -recovery_m : 0.0);
}

/// Half-space with the largest permitted fraction of the move, if none contains its end. There are two choices. The
/// distance from a triangle is a convex function of the position, so its tangent at the start excludes no free position
/// close to the start. The plane of the triangle lets the tip slide up to a concave edge.
std::optional<HalfSpace> excluding_space(const geometry::Triangle& triangle, const Move& move, const glm::dvec3& way_m,
                                         double distance_m) {
  const auto plane_normal = [&] {
    const glm::dvec3 normal = glm::cross(triangle.b_m - triangle.a_m, triangle.c_m - triangle.a_m);
    const double length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3{};
  };
  const HalfSpace tangent{distance_m > 1e-12 ? way_m / distance_m : plane_normal(), limited_slack_m(distance_m, move)};
  if (tangent.height_m(move.way_m) >= -resolution_m) return std::nullopt;
  HalfSpace plane{plane_normal(), 0};
  double height_m = glm::dot(plane.normal, move.start_m - triangle.a_m);
  if (height_m < 0) {
    height_m = -height_m;
    plane.normal = -plane.normal;
  }
  plane.slack_m = height_m - move.radius_m;
  if (plane.slack_m < 0) return tangent;
  if (plane.height_m(move.way_m) >= -resolution_m) return std::nullopt;
  return permitted(plane, move.way_m) > permitted(tangent, move.way_m) ? plane : tangent;
}

std::optional<HalfSpace> excluding_space(const SolidPoint& point, const PlacedObject& placed, const Move& move) {
  const HalfSpace tangent{placed.rotation * point.normal, limited_slack_m(point.distance_m, move)};
  if (tangent.height_m(move.way_m) >= -resolution_m) return std::nullopt;
  return tangent;
}

bool is_in_reach(const PlacedObject& placed, const Move& move) {
  const double reach_m = move.radius_m + glm::length(move.way_m) + static_cast<double>(placed.surface->radius_m());
  const glm::dvec3 from_middle_m = move.start_m - placed.origin_m;
  return glm::dot(from_middle_m, from_middle_m) <= reach_m * reach_m;
}

/// The closest obstacle among those that were tried.
class ClosestObstacle {
 public:
  explicit ClosestObstacle(const Move& move) : move_(move) {}

  const std::optional<Obstacle>& found() const { return found_; }
  /// A more distant face is not the result.
  double limit_m() const { return least_m_ + equally_close_m; }

  void try_solid(std::size_t index, const PlacedObject& placed) {
    const SolidPoint point = closest_point_of_solid(placed.object->shape, placed.to_object(move_.start_m));
    if (point.distance_m >= least_m_ - equally_close_m) return;
    if (const auto space = excluding_space(point, placed, move_)) set({index, 0}, point.distance_m, *space, move_);
  }

  void try_face(std::size_t index, const PlacedObject& placed, const LocalMove& local, std::uint32_t face) {
    const geometry::Triangle triangle = placed.surface->triangle(face);
    if (local.is_protected(triangle)) return;
    const glm::dvec3 way_m = local.move.start_m - geometry::closest_point(local.move.start_m, triangle).point_m;
    const double squared_m2 = glm::dot(way_m, way_m);
    if (squared_m2 >= limit_m() * limit_m()) return;
    const double distance_m = std::sqrt(squared_m2);
    const auto space = excluding_space(triangle, local.move, way_m, distance_m);
    if (!space) return;
    if (distance_m > least_m_ - equally_close_m && space->height_m(local.move.way_m) >= lowest_m_) return;
    set({index, face}, distance_m, *space, local.move);
    found_->space.normal = placed.rotation * space->normal;
  }

 private:
  void set(const FaceOfObject& face, double distance_m, const HalfSpace& space, const Move& move) {
    found_ = {face, distance_m, space};
    least_m_ = distance_m;
    lowest_m_ = space.height_m(move.way_m);
  }

  const Move& move_;
  std::optional<Obstacle> found_;
  double least_m_ = 1e6;
  double lowest_m_ = 0;  // of the end of the move above the border of the found obstacle
};

}  // namespace

bool NearFaces::contain(const Move& move) const {
  return glm::distance(center_m, move.start_m) + glm::length(move.way_m) + move.radius_m <= reach_m;
}

void NearFaces::find(std::span<const PlacedObject> objects, const glm::dvec3& center, double reach) {
  center_m = center;
  reach_m = reach;
  count = 0;
  for (std::size_t index = 0; index < objects.size(); ++index) {
    const PlacedObject& placed = objects[index];
    if (!placed.is_felt || !placed.surface || !is_in_reach(placed, {center, {}, reach, false})) continue;
    const Tree& tree = placed.surface->tree();
    const glm::vec3 local_m{placed.to_object(center)};
    const float limit_m2 = geometry::square(tree.padded_m(static_cast<float>(reach)));
    const auto is_near = [&](const Tree::Node& node) {
      return reach_m != too_many && node.squared_distance_m2(local_m, limit_m2) <= limit_m2;
    };
    tree.visit_if(is_near, [&](std::uint32_t face) {
      if (count < list.size())
        list[count++] = {index, face};
      else
        reach_m = too_many;
    });
  }
}

std::optional<Obstacle> find_obstacle(std::span<const PlacedObject> objects, const NearFaces& near, const Move& move,
                                      std::span<const HalfSpace> active) {
  const double reach_m = move.radius_m + glm::length(move.way_m);
  const bool is_near = near.contain(move);
  ClosestObstacle closest(move);
  std::size_t number = 0;  // of the near face
  for (std::size_t index = 0; index < objects.size(); ++index) {
    const PlacedObject& placed = objects[index];
    if (!placed.is_felt) continue;
    if (!placed.surface) {
      closest.try_solid(index, placed);
      continue;
    }
    if (!is_in_reach(placed, move)) continue;
    const LocalMove local(placed, move, active);
    if (is_near) {
      while (number < near.count && near.list[number].object < index) ++number;
      for (; number < near.count && near.list[number].object == index; ++number)
        closest.try_face(index, placed, local, near.list[number].face);
      continue;
    }
    auto search_m = static_cast<float>(std::min(closest.limit_m(), reach_m));
    placed.surface->tree().visit_closest_if(
        glm::vec3{local.move.start_m}, search_m, [&](const Tree::Node& node) { return local.concerns(node); },
        [&](std::uint32_t face, float& radius_m) {
          closest.try_face(index, placed, local, face);
          radius_m = std::min(radius_m, static_cast<float>(closest.limit_m()));
        });
  }
  return closest.found();
}

std::optional<Obstacle> find_obstacle(std::span<const PlacedObject> objects, const Move& move,
                                      const FaceOfObject& face) {
  const PlacedObject& placed = objects[face.object];
  if (!placed.is_felt || !placed.surface) return std::nullopt;
  Move local = move;
  local.start_m = placed.to_object(move.start_m);
  local.way_m = placed.turned_to_object(move.way_m);
  const geometry::Triangle triangle = placed.surface->triangle(face.face);
  const geometry::ClosestPoint closest = geometry::closest_point(local.start_m, triangle);
  if (closest.region != geometry::Region::face) return std::nullopt;
  const glm::dvec3 way_m = local.start_m - closest.point_m;
  const double distance_m = glm::length(way_m);
  auto space = excluding_space(triangle, local, way_m, distance_m);
  if (!space) return std::nullopt;
  space->normal = placed.rotation * space->normal;
  return Obstacle{face, distance_m, *space};
}

double free_fraction(std::span<const PlacedObject> objects, const Move& move, std::span<const HalfSpace> active) {
  double fraction = 1;
  for (const HalfSpace& space : active) fraction = std::min(fraction, permitted(space, move.way_m));
  for (const PlacedObject& placed : objects) {
    if (!placed.is_felt) continue;
    if (!placed.surface) {
      const SolidPoint point = closest_point_of_solid(placed.object->shape, placed.to_object(move.start_m));
      if (const auto space = excluding_space(point, placed, move))
        fraction = std::min(fraction, permitted(*space, move.way_m));
      continue;
    }
    if (!is_in_reach(placed, move)) continue;
    const LocalMove local(placed, move, active);
    placed.surface->tree().visit_if(
        [&](const Tree::Node& node) { return local.concerns(node); },
        [&](std::uint32_t face) {
          const geometry::Triangle triangle = placed.surface->triangle(face);
          const glm::dvec3 way_m = local.move.start_m - geometry::closest_point(local.move.start_m, triangle).point_m;
          const auto space = excluding_space(triangle, local.move, way_m, glm::length(way_m));
          if (space && !local.is_protected(triangle))
            fraction = std::min(fraction, permitted(*space, local.move.way_m));
        });
  }
  return fraction;
}

}  // namespace inkwell::contact
