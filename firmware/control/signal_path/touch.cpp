#include "firmware/control/signal_path/touch.hpp"

#include <bit>

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

constexpr Vector3 zero{};
constexpr Motion still{};
constexpr std::array<Vector3, 6> wall_normals{{{1.0f, 0.0f, 0.0f},
                                               {-1.0f, 0.0f, 0.0f},
                                               {0.0f, 1.0f, 0.0f},
                                               {0.0f, -1.0f, 0.0f},
                                               {0.0f, 0.0f, 1.0f},
                                               {0.0f, 0.0f, -1.0f}}};

/// Solids whose tangent planes are renewed in the first period of a touch.
constexpr std::size_t renewals_maximum = 2;
/// Square of the sine of the smallest angle between two barriers that count as two.
constexpr float flat_sine_squared = 1e-5f;
/// Square of the smallest volume of three normals that count as three. On a curved surface, the normals have small
/// angles and a small volume.
constexpr float flat_volume_squared = 1e-10f;

constexpr float least(float a, float b) { return a < b ? a : b; }

/// Distance between probe and the point `out_m` away from the probe, measured into the barrier.
float depth_at(const Barrier& barrier, const Vector3& out_m) { return barrier.depth_m - dot(barrier.normal, out_m); }

const Barrier* deepest(const Barriers& barriers, const Vector3& out_m) {
  const Barrier* found = nullptr;
  float depth_m = depth_tolerance_m;
  for (std::size_t i = 0; i < barriers.count; ++i) {
    const float each_m = depth_at(barriers.list[i], out_m);
    if (each_m <= depth_m) continue;
    depth_m = each_m;
    found = &barriers.list[i];
  }
  return found;
}

[[gnu::noinline]] void set_one(Support& support, const Barrier& a) {
  support.count = 0;
  support.add(a, a.depth_m);
  support.out_m = a.depth_m * a.normal;
}

/// Sets the support of two barriers, or of one barrier if only that barrier pushes.
void set_two(Support& support, const Barrier& a, const Barrier& b) {
  // A cosine near 1 would lose the digits of small angles.
  const Vector3 between = a.normal - b.normal;
  const float one_minus_cosine = 0.5f * dot(between, between);
  const float sine_squared = one_minus_cosine * (2.0f - one_minus_cosine);
  const float deeper_m = a.depth_m - b.depth_m;
  const float a_m = one_minus_cosine * b.depth_m + deeper_m;
  const float b_m = one_minus_cosine * a.depth_m - deeper_m;
  if (a_m <= 0.0f) return set_one(support, b);
  if (b_m <= 0.0f || sine_squared < flat_sine_squared) return set_one(support, a);
  const float per_sine_squared = reciprocal(sine_squared);
  support.count = 0;
  support.add(a, per_sine_squared * a_m);
  support.add(b, per_sine_squared * b_m);
  support.depth_m[2] = 0.0f;
  support.out_m = support.depth_m[0] * a.normal + support.depth_m[1] * b.normal;
}

/// Sets the support of two barriers `a` and `b` and of a barrier `c` that excludes their point. Then `c` belongs to the
/// support. Nearly parallel barriers count as two.
void set_three(Support& support, const Barrier& a, const Barrier& b, const Barrier& c) {
  const Vector3 bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal), ab = cross(a.normal, b.normal);
  const float volume = dot(a.normal, bc);
  if (volume * volume > flat_volume_squared) {
    const float per_volume = volume * reciprocal(volume * volume);
    const Vector3 corner_m = per_volume * (a.depth_m * bc + b.depth_m * ca + c.depth_m * ab);
    const float a_m = per_volume * dot(corner_m, bc), b_m = per_volume * dot(corner_m, ca);
    if (a_m > 0.0f && b_m > 0.0f) {
      support.add(c, per_volume * dot(corner_m, ab));
      support.depth_m[0] = a_m;
      support.depth_m[1] = b_m;
      support.out_m = corner_m;
      return;
    }
  }
  set_two(support, a, c);
  if (depth_at(b, support.out_m) > depth_tolerance_m) set_two(support, b, c);
}

/// Part of the damper of each barrier that acts. It is 1 for barriers at right angles. The parts of parallel barriers
/// have the sum 1, so that two parallel surfaces do not damp twice. `per_sum` is the reciprocal of the sum of the
/// depths.
std::array<float, 3> damper_parts(const Support& support, float per_sum) {
  const auto [a, b, c] = support.barriers;
  const auto [a_m, b_m, c_m] = support.depth_m;
  const auto common = [per_sum](const Barrier& first, const Barrier& second) {
    const float cosine = dot(first.normal, second.normal);
    return per_sum * cosine * cosine;
  };
  const float ab = common(*a, *b);
  std::array<float, 3> parts{1.0f - ab * b_m, 1.0f - ab * a_m, 1.0f};
  if (support.count == 2) return parts;
  const float ac = common(*a, *c), bc = common(*b, *c);
  parts[0] -= ac * c_m;
  parts[1] -= bc * c_m;
  parts[2] -= ac * a_m + bc * b_m;
  return parts;
}

/// Friction on the surface of the main barrier.
struct Friction {
  Vector3 force_N;
  Vector3 lag_m;  ///< from the frictionless proxy to the proxy
  bool slides;
};

/// Below this square of a force the direction is undefined (1 uN).
constexpr float smallest_squared_N2 = 1e-12f;

/// Stick-slip friction (Salisbury et al., "Haptic rendering: programming touch interaction with virtual objects", I3D
/// 1995). `velocity_m_per_s` is tangential. The lag of the previous proxy is a stretched spring.
Friction find_friction(const Surface& surface, const Vector3& lag_m, const Vector3& velocity_m_per_s, float normal_N,
                       bool slides) {
  const Vector3 held_N = surface.stiffness_N_per_m * lag_m - surface.damping_Ns_per_m * velocity_m_per_s;
  const float bound_N = normal_N * (slides ? surface.dynamic_friction : surface.static_friction);
  const float squared_N2 = dot(held_N, held_N);
  if (squared_N2 <= bound_N * bound_N + smallest_squared_N2) return {held_N, lag_m, false};
  const float part = surface.dynamic_friction * normal_N * reciprocal_square_root(squared_N2);
  return {part * held_N, (part * surface.m_per_N) * held_N, true};
}

/// Returns the vector from the frictionless proxy to a held point. The held point, relative to the probe, leaves the
/// barriers. If it is in none of them, it falls along the normal by its distance from the nearest barrier. In a groove,
/// the point may be on one of the surfaces.
Vector3 find_lag_m(const Barriers& barriers, const Support& support, Vector3 held_m, const Vector3& normal) {
  float height_m = 1.0f;
  for (std::size_t i = 0; i < barriers.count; ++i) {
    const float depth_m = depth_at(barriers.list[i], held_m);
    if (depth_m > 0.0f) held_m = held_m + depth_m * barriers.list[i].normal;
    height_m = least(height_m, depth_m > 0.0f ? 0.0f : -depth_m);
  }
  return held_m - height_m * normal - support.out_m;
}

Vector3 viscous_force_N(const Surface& surface, const Vector3& velocity_m_per_s, float normal_N) {
  return bounded(-surface.viscosity_Ns_per_m * velocity_m_per_s, normal_N).force_N;
}

}  // namespace

// Each pass adds the barrier that excludes the point most. At most three barriers remain.
void find_support(const Barriers& barriers, Support& support) {
  set_one(support, *barriers.deepest.barrier);
  if (barriers.count == 1) return;
  const Barrier* next = deepest(barriers, support.out_m);
  if (next == nullptr) return;
  set_two(support, *support.barriers[0], *next);
  if (barriers.count == 2) return;
  next = deepest(barriers, support.out_m);
  if (next == nullptr) return;
  if (support.count == 1)
    set_two(support, *support.barriers[0], *next);
  else
    set_three(support, *support.barriers[0], *support.barriers[1], *next);
}

void Barriers::add(const Vector3& normal, float depth_m, const Surface& surface, const Motion& motion) {
  Barrier* free = end();
  if (count == maximum) {
    do {
      if (replaced == list.data()) return;
      free = --replaced;
    } while (free->depth_m > 0.0f);
  } else {
    ++count;
  }
  free->set(normal, depth_m, surface, motion);
  deepest.note(*free, depth_m);
}

void Touch::follow(LocalModel& model) {
  model_ = model.count != 0 ? &model : nullptr;
  model_rise_part_ = 0.0f;
  renewed_ = model.features.data();
#pragma GCC unroll 1
  for (std::size_t i = 0; i < model.count; ++i) {
    Feature& feature = model.features[i];
    const float depth_m = feature.tangent.offset_m - dot(feature.tangent.normal, proxy_m_);
    feature.recess_m = depth_m > 0.0f ? depth_m : 0.0f;
  }
}

bool Touch::age() {
  const bool shapes_changed = shapes.age();
  return age_model() || shapes_changed;
}

bool Touch::age_model() {
  if (model_ == nullptr) return false;
  if (model_->life_periods == 0) {
    model_ = nullptr;
    return true;
  }
  --model_->life_periods;
  model_->age_s += protocol::servo_period_s;
  return false;
}

void Touch::add_walls(const Vector3& probe_m, const Box& walls, const Surface& wall) {
  const Vector3* normals = wall_normals.data();
#pragma GCC unroll 1
  for (const auto axis : {&Vector3::x, &Vector3::y, &Vector3::z}) {
    const float low_m = walls.minimum_m.*axis - probe_m.*axis, high_m = probe_m.*axis - walls.maximum_m.*axis;
    const bool is_low = low_m > high_m;
    const float depth_m = is_low ? low_m : high_m;
    if (barriers_.is_in_reach(depth_m)) barriers_.add(normals[is_low ? 0 : 1], depth_m, wall, still);
    normals += 2;
  }
}

[[gnu::noinline]] void Touch::add_near_shapes(const Vector3& probe_m, float margin_m) {
  const float height_m = -barriers_.reach_m;
  const Vector3 at_m = probe_m;
  std::size_t renewals = 0;
  for (std::uint32_t near = shapes.near(); near != 0; near &= near - 1) {
    const auto number = static_cast<std::size_t>(std::countr_zero(near));
    const Plane& plane = shapes.plane(number);
    float depth_m = plane.offset_m - dot(plane.normal, at_m);
    if (!(depth_m > height_m)) continue;
    // A touch does not begin at a tangent plane of another position. Solids that are not renewed are found in turn.
    if (!touches_ && number >= Shapes::planes_maximum) {
      if (renewals++ >= renewals_maximum || !shapes.renew(number, proxy_m_, margin_m)) {
        shapes.forget(number);
        continue;
      }
      depth_m = plane.offset_m - dot(plane.normal, at_m);
    }
    barriers_.add(plane.normal, depth_m, shapes.surface(number), still);
  }
}

void Touch::add_model(const Vector3& probe_m) {
  LocalModel& model = *model_;
  Feature* const first = model.features.data();
  const Feature* const end = first + model.count;
  ++renewed_;
  if (renewed_ >= end) renewed_ = first;
  const float age_s = model.age_s;
  renew_tangent(*renewed_, proxy_m_, age_s);
  const Vector3 at_m = probe_m;
  const float height_m = -barriers_.reach_m;
  const float rise_part = model_rise_part_;
  Barrier* free = barriers_.end();
  static_assert(wall_normals.size() / 2 + protocol::local_features_maximum <= Barriers::maximum, "the list needs room");
  Deepest deepest = barriers_.deepest;
  Feature* feature = first;
#pragma GCC unroll 1
  do {
    const float rise_m = least(feature->recess_m, rise_part * feature->rise_limit_m);
    feature->motion.rise_m = rise_m;
    feature->recess_m -= rise_m;
    const Plane tangent = feature->tangent;
    const float depth_m =
        tangent.offset_m - feature->recess_m + age_s * feature->tangent_speed_m_per_s - dot(tangent.normal, at_m);
    if (depth_m > height_m) [[likely]] {
      free->set(tangent.normal, depth_m, feature->surface, feature->motion);
      deepest.note(*free++, depth_m);
    }
  } while (++feature != end);
  barriers_.deepest = deepest;
  barriers_.count = static_cast<std::size_t>(free - barriers_.list.data());
}

const TouchForce& Touch::step(const Vector3& probe_m, const Vector3& velocity_m_per_s, const Box* walls,
                              const Surface& wall, const ForceLimit& limit) {
  if (!touches_) proxy_m_ = probe_m;
  force_ = {};
  barriers_.clear();
  if (walls != nullptr) add_walls(probe_m, *walls, wall);
  if (model_ != nullptr) add_model(probe_m);
  if (shapes.any()) {
    const float margin_m = near_margin_m(barriers_.reach_m);
    shapes.examine(proxy_m_, margin_m);
    if (shapes.near() != 0) add_near_shapes(probe_m, margin_m);
  }
  if (barriers_.deepest.barrier != nullptr) return push(probe_m, velocity_m_per_s, wall, limit);
  release(probe_m);
  return force_;
}

[[gnu::noinline]] const TouchForce& Touch::push(const Vector3& probe_m, const Vector3& velocity_m_per_s,
                                                const Surface& wall, const ForceLimit& limit) {
  find_support(barriers_, support_);
  const Support& support = support_;
  touches_ = true;
  barriers_.reach_m = support.depth_m[0];
  std::array<float, 3> parts{1.0f, 1.0f, 1.0f};
  float rise_part = 1.0f;
  if (support.count > 1) {
    barriers_.reach_m += support.depth_m[1] + support.depth_m[2];
    const float per_reach_per_m = reciprocal(barriers_.reach_m);
    rise_part = dot(support.out_m, support.out_m) * per_reach_per_m * per_reach_per_m;
    parts = damper_parts(support, per_reach_per_m);
  }
  rise_part_ = model_rise_part_ = least(rise_part, 2.0f * rise_part_);
  Vector3 normal_sum_N;
  float most_N = 0.0f;
  const Barrier* main = support.barriers[0];
#pragma GCC unroll 1
  for (std::size_t i = 0; i < support.count; ++i) {
    const Barrier& barrier = *support.barriers[i];
    const float speed_m_per_s = dot(barrier.normal, velocity_m_per_s - barrier.motion->velocity_m_per_s);
    const float push_N = barrier.surface->stiffness_N_per_m * support.depth_m[i] -
                         parts[i] * barrier.surface->damping_Ns_per_m * speed_m_per_s;
    const float normal_N = push_N > 0.0f ? push_N : 0.0f;
    force_.raised_J += normal_N * barrier.motion->rise_m;
    const Vector3 pushed_N = normal_N * barrier.normal;
    normal_sum_N = normal_sum_N + pushed_N;
    if (barrier.surface == &wall) force_.walls_N = force_.walls_N + pushed_N;
    if (normal_N <= most_N) continue;
    most_N = normal_N;
    main = &barrier;
  }
  force_.objects_N = normal_sum_N - force_.walls_N;
  const Vector3 frictionless_m = probe_m + support.out_m;
  const Vector3 held_m = proxy_m_ + protocol::servo_period_s * main->motion->velocity_m_per_s;
  proxy_m_ = frictionless_m;
  const Surface& surface = *main->surface;
  const float squared_N2 = dot(normal_sum_N, normal_sum_N);
  if ((surface.static_friction == 0.0f && surface.viscosity_Ns_per_m == 0.0f) || squared_N2 < smallest_squared_N2)
    return force_;
  const float per_N = reciprocal_square_root(squared_N2);
  const Vector3 normal = per_N * normal_sum_N;
  const float normal_N = squared_N2 * per_N;
  Vector3& main_N = main->surface == &wall ? force_.walls_N : force_.objects_N;
  const auto tangential = [&normal](const Vector3& vector) { return vector - dot(vector, normal) * normal; };
  const Vector3 sideways_m_per_s = tangential(velocity_m_per_s - main->motion->velocity_m_per_s);
  if (surface.static_friction != 0.0f) {
    const Vector3 lag_m = find_lag_m(barriers_, support, held_m - probe_m, normal);
    // The limit of the force scales the whole force, so the friction compensates for the scaling.
    float felt_N = normal_N, beyond = normal_N * limit.per_limit_per_N;
    if (beyond > 1.0f)
      felt_N = limit.limit_N;
    else
      beyond = 1.0f;
    const Friction held = find_friction(surface, lag_m, sideways_m_per_s, felt_N, slides_);
    slides_ = held.slides;
    proxy_m_ = frictionless_m + held.lag_m;
    main_N = main_N + beyond * held.force_N;
  }
  if (surface.viscosity_Ns_per_m != 0.0f) main_N = main_N + viscous_force_N(surface, sideways_m_per_s, normal_N);
  return force_;
}

}  // namespace inkwell::control
