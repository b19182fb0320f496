#include "host/contact/step.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "host/contact/features.hpp"
#include "host/contact/half_spaces.hpp"
#include "host/contact/selection.hpp"
#include "host/contact/slide.hpp"
#include "host/contact/solids.hpp"

namespace inkwell::contact {
namespace {

/// A contact whose distance exceeds the tip's radius by no more than this is touched.
constexpr double touch_m = 3e-6;
/// A feature is the same as in the previous step if its point moved by less than this plus the motion of the proxy,
/// and its normal turned by less than 60 degrees.
constexpr double tracking_m = 0.0005;
constexpr double tracking_cosine = 0.5;
/// A smaller normal force does not show the proxy of the board.
constexpr double force_min_N = 0.02;

struct PlacedObjects {
  std::array<PlacedObject, objects_max> objects;
  /// In the previous step. nullptr: the object is new.
  std::array<const Tool::KnownObject*, objects_max> known;
  std::size_t count;

  std::span<PlacedObject> all() { return {objects.data(), count}; }
};

bool contains(const PlacedObject& placed, const glm::dvec3& point_m) {
  const glm::dvec3 local_m = placed.to_object(point_m);
  return placed.surface ? placed.surface->contains(local_m)
                        : closest_point_of_solid(placed.object->shape, local_m).distance_m < 0;
}

/// True if the tip touches or overlaps the object.
bool overlaps(const PlacedObject& placed, const glm::dvec3& center_m, double radius_m) {
  const glm::dvec3 local_m = placed.to_object(center_m);
  if (!placed.surface) return closest_point_of_solid(placed.object->shape, local_m).distance_m < radius_m;
  return placed.surface->closest(local_m, radius_m).has_value() || placed.surface->contains(local_m);
}

/// The same object in the previous step. `index`: its number in this step, which is usually the same.
const Tool::KnownObject* find_known(const Tool& tool, const Object& object, std::size_t index) {
  const auto is_same = [&](const Tool::KnownObject& known) { return known.id == object.id; };
  if (index < tool.known_count && is_same(tool.known[index])) return &tool.known[index];
  const auto end = tool.known.begin() + static_cast<std::ptrdiff_t>(tool.known_count);
  const auto found = std::find_if(tool.known.begin(), end, is_same);
  return found == end ? nullptr : &*found;
}

void place_objects(PlacedObjects& placed, const Scene& scene, const Tool& tool, double age_s, double radius_m) {
  placed.count = std::min(scene.objects.size(), objects_max);
  for (std::size_t index = 0; index < placed.count; ++index) {
    const Object& object = scene.objects[index];
    const Placement now = placement_after(object, age_s);
    PlacedObject& entry = placed.objects[index] = place(object, now);
    const Tool::KnownObject* known = find_known(tool, object, index);
    if (known && known->surface != entry.surface) known = nullptr;
    placed.known[index] = known;
    entry.is_moving = known && !(known->placement == now);
    // An object that appears around the tip is not felt until the tip has left it.
    if (!known || known->is_ignored) entry.is_felt = entry.is_felt && !overlaps(entry, tool.proxy_m, radius_m);
  }
}

void store_objects(Tool& tool, const PlacedObjects& placed, double age_s) {
  tool.known_count = placed.count;
  for (std::size_t index = 0; index < placed.count; ++index) {
    const PlacedObject& entry = placed.objects[index];
    tool.known[index] = {entry.object->id, entry.surface, placement_after(*entry.object, age_s), !entry.is_felt};
  }
}

/// The faces that limited the tip in the previous step, if their objects still exist.
LimitingFaces find_limiting(const Tool& tool, const PlacedObjects& placed) {
  LimitingFaces limiting;
  for (std::size_t number = 0; number < tool.limiting_count; ++number)
    for (std::size_t index = 0; index < placed.count; ++index)
      if (placed.known[index] && placed.known[index]->id == tool.limiting[number].object)
        limiting.faces[limiting.count++] = {index, tool.limiting[number].face};
  return limiting;
}

void store_limiting(Tool& tool, const PlacedObjects& placed, const LimitingFaces& limiting) {
  tool.limiting_count = limiting.count;
  for (std::size_t number = 0; number < limiting.count; ++number)
    tool.limiting[number] = {placed.objects[limiting.faces[number].object].object->id, limiting.faces[number].face};
}

/// Pushes the proxy out of the way of moving objects.
void follow_motion(PlacedObjects& placed, Tool& tool, LimitingFaces& limiting, double age_s, double radius_m) {
  const glm::dvec3 start_m = tool.proxy_m;
  const bool any_moves =
      std::ranges::any_of(placed.all(), [](const PlacedObject& entry) { return entry.is_moving && entry.is_felt; });
  if (!any_moves) return;
  std::array<bool, objects_max> is_felt{};
  for (std::size_t index = 0; index < placed.count; ++index) is_felt[index] = placed.objects[index].is_felt;
  // Only objects that do not move, and moving objects whose motion is done, stop the pushed tip.
  const auto feel_only = [&](const auto& predicate) {
    for (std::size_t index = 0; index < placed.count; ++index)
      placed.objects[index].is_felt = is_felt[index] && predicate(index);
  };
  for (std::size_t index = 0; index < placed.count; ++index) {
    PlacedObject& moving = placed.objects[index];
    if (!moving.is_moving || !is_felt[index]) continue;
    // In the frame of the object, the proxy moves from its carried position to its position.
    const glm::dvec3 carried_m =
        placement_after(*moving.object, age_s).to_workspace(placed.known[index]->placement.to_object(start_m));
    feel_only([&](std::size_t other) { return other == index; });
    const glm::dvec3 pushed_m = slide(placed.all(), limiting, carried_m, tool.proxy_m, radius_m);
    if (pushed_m == tool.proxy_m) continue;
    feel_only([&](std::size_t other) { return other < index || (other != index && !placed.objects[other].is_moving); });
    tool.proxy_m = slide(placed.all(), limiting, tool.proxy_m, pushed_m, radius_m);
    if (glm::distance(tool.proxy_m, pushed_m) > skin_m && contains(moving, tool.proxy_m)) is_felt[index] = false;
  }
  feel_only([](std::size_t) { return true; });
}

/// Material of the object that limited the last move, and the position to which its surface carries the proxy.
struct Hold {
  const Material* material = nullptr;
  glm::dvec3 held_m;
};

Hold find_hold(const Scene& scene, const PlacedObjects& placed, const LimitingFaces& limiting, double age_s,
               const glm::dvec3& before_m) {
  if (limiting.count == 0) return {};
  const std::size_t index = limiting.faces[0].object;
  const PlacedObject& entry = placed.objects[index];
  const Hold hold{&scene.materials[entry.object->material], before_m};
  if (!entry.is_moving) return hold;
  const Placement now = placement_after(*entry.object, age_s);
  return {hold.material, now.to_workspace(placed.known[index]->placement.to_object(before_m))};
}

/// The proxy, held back by friction like the proxy of the board. The features at a proxy without friction would belong
/// to another part of the surface. The force of the board shows its proxy, so that the two proxies do not drift apart.
glm::dvec3 held_back_m(Tool& tool, Hold hold, const glm::dvec3& frictionless_m, const Pose& pose) {
  const Material& material = *hold.material;
  const glm::dvec3 out_m = frictionless_m - pose.position_m;
  const double depth_m = glm::length(out_m);
  if (!(depth_m > skin_m)) return frictionless_m;
  const glm::dvec3 normal = out_m / depth_m;
  if (material.stiffness_N_per_m > 0 && glm::dot(pose.force_N, normal) > force_min_N) {
    const glm::dvec3 spring_N = pose.force_N + static_cast<double>(material.damping_Ns_per_m) * pose.velocity_m_per_s;
    hold.held_m = pose.position_m + spring_N / static_cast<double>(material.stiffness_N_per_m);
  }
  glm::dvec3 lag_m = hold.held_m - frictionless_m;
  lag_m -= normal * glm::dot(normal, lag_m);
  const double length_m = glm::length(lag_m);
  // The friction follows the normal force that the hand feels.
  const double felt_m = pose.force_limit_N > 0
                            ? std::min(depth_m, pose.force_limit_N / static_cast<double>(material.stiffness_N_per_m))
                            : depth_m;
  const auto bound_m = [&](float friction) { return static_cast<double>(friction) * felt_m; };
  tool.slides = length_m > bound_m(tool.slides ? material.dynamic_friction : material.static_friction);
  if (tool.slides) lag_m *= bound_m(material.dynamic_friction) / length_m;
  return frictionless_m + lag_m;
}

std::uint32_t track(Tool& tool, const Candidate& candidate, std::uint32_t object, double moved_m,
                    std::array<bool, features_max>& is_used) {
  std::size_t best = features_max;
  double least_m = tracking_m + 2 * moved_m;
  for (std::size_t index = 0; index < tool.tracked_count; ++index) {
    const Tool::TrackedFeature& tracked = tool.tracked[index];
    const double distance_m = glm::distance(tracked.point_m, candidate.point_m);
    if (is_used[index] || tracked.object != object || distance_m > least_m ||
        glm::dot(tracked.normal, candidate.normal) < tracking_cosine)
      continue;
    best = index;
    least_m = distance_m;
  }
  if (best == features_max) return ++tool.last_id;
  is_used[best] = true;
  return tool.tracked[best].id;
}

}  // namespace

Step step(const Scene& scene, Tool& tool, const Pose& pose) {
  const double radius_m = std::max(tool.radius_m, tip_radius_min_m);
  if (!tool.is_placed) {
    tool.proxy_m = pose.position_m;
    tool.known_count = tool.tracked_count = tool.limiting_count = 0;
    tool.is_placed = true;
  }
  const glm::dvec3 before_m = tool.proxy_m;
  PlacedObjects placed;
  place_objects(placed, scene, tool, pose.scene_age_s, radius_m);
  LimitingFaces limiting = find_limiting(tool, placed);
  follow_motion(placed, tool, limiting, pose.scene_age_s, radius_m);
  const glm::dvec3 start_m = tool.proxy_m;
  tool.proxy_m = slide(placed.all(), limiting, start_m, pose.position_m, radius_m);
  const Hold hold = find_hold(scene, placed, limiting, pose.scene_age_s, before_m);
  if (hold.material != nullptr && hold.material->static_friction > 0)
    tool.proxy_m = slide(placed.all(), limiting, start_m, held_back_m(tool, hold, tool.proxy_m, pose), radius_m);
  store_limiting(tool, placed, limiting);
  store_objects(tool, placed, pose.scene_age_s);

  Step result;
  result.proxy_m = tool.proxy_m;
  const Candidates candidates = select_features(placed.all(), limiting, pose, tool.proxy_m, radius_m);
  const double moved_m = glm::distance(before_m, tool.proxy_m);

  LocalModel& model = result.model;
  model.pose_sequence = pose.sequence;
  model.anchor_m = glm::round(glm::vec3{tool.proxy_m} / anchor_grid_m) * anchor_grid_m;
  const PlacedObject* moving = nullptr;
  std::array<Tool::TrackedFeature, features_max> tracked{};
  std::array<bool, features_max> is_used{};
  for (const Candidate& candidate : candidates.all()) {
    const PlacedObject& owner = placed.objects[candidate.object];
    const Object& object = *owner.object;
    Feature& feature = model.features[model.count];
    feature = candidate.feature;
    feature.id = track(tool, candidate, object.id, moved_m, is_used);
    feature.material = object.material;
    // The model has one velocity: of the nearest moving object.
    if (!moving && object.moves() && pose.scene_age_s < motion_max_s) moving = &owner;
    feature.moves = moving == &owner;
    tracked[model.count] = {feature.id, object.id, candidate.normal, candidate.point_m};
    ++model.count;

    if (candidate.distance_m > radius_m + touch_m) continue;
    const double depth_m = glm::dot(candidate.normal, tool.proxy_m - pose.position_m);
    result.contacts[result.contact_count++] = {glm::vec3{candidate.point_m}, glm::vec3{candidate.normal}, object.id,
                                               owner.surface ? owner.surface->original_face(candidate.face) : 0,
                                               static_cast<float>(std::max(depth_m, 0.0))};
  }
  tool.tracked = tracked;
  tool.tracked_count = model.count;
  if (moving) {
    const Object& object = *moving->object;
    const glm::dvec3 arm_m = glm::dvec3{model.anchor_m} - placement_after(object, pose.scene_age_s).position_m;
    model.velocity_m_per_s = glm::vec3{object.velocity_m_per_s + glm::cross(object.spin_rad_per_s, arm_m)};
    model.spin_rad_per_s = glm::vec3{object.spin_rad_per_s};
  }
  return result;
}

glm::dvec3 project(const LocalModel& model, const glm::dvec3& position_m) {
  // The tangent planes at the last position are repeated until they do not turn any more.
  constexpr int repetitions = 20;
  glm::dvec3 projected_m = position_m;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    ClosestPosition closest({});
    for (int pass = 0; pass < 4; ++pass) {
      bool is_done = true;
      for (std::size_t index = 0; index < model.count; ++index) {
        const Feature& feature = model.features[index];
        const glm::dvec3 direction{feature.direction};
        glm::dvec3 way_m = projected_m - glm::dvec3{feature.point_m};
        glm::dvec3 normal = direction;
        if (feature.kind == Feature::Kind::cylinder) way_m -= direction * glm::dot(direction, way_m);
        if (feature.kind != Feature::Kind::plane && glm::length(way_m) > 1e-9) normal = glm::normalize(way_m);
        const double height_m = glm::dot(normal, way_m) - static_cast<double>(feature.radius_m);
        const HalfSpace space{normal, height_m + glm::dot(normal, position_m - projected_m)};
        if (space.height_m(closest.position()) >= -1e-9) continue;
        is_done = !closest.add(space) && is_done;
      }
      if (is_done) break;
    }
    const glm::dvec3 next_m = position_m + closest.position();
    const bool is_still = glm::distance(next_m, projected_m) < 1e-9;
    projected_m = next_m;
    if (is_still) break;
  }
  return projected_m;
}

}  // namespace inkwell::contact
