#include "firmware/control/signal_path/touch.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

constexpr Vector3 zero{};

/// Largest increase of the force of a recessed surface in a period.
constexpr float rise_N = 4e-3f;
/// Depth above which a barrier excludes a point. Rounding errors are smaller.
constexpr float depth_tolerance_m = 1e-7f;
/// Square of the sine of the smallest angle between two barriers that count as two.
constexpr float flat_sine_squared = 1e-5f;

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

void set_one(Support& support, const Barrier& a) {
  support.count = 0;
  support.add(a, a.depth_m);
  support.out_m = a.depth_m * a.normal;
}

/// Sets the support of two barriers, or of one barrier if only that barrier pushes.
void set_two(Support& support, const Barrier& a, const Barrier& b) {
  const float cosine = dot(a.normal, b.normal);
  const float sine_squared = 1.0f - cosine * cosine;
  const float a_m = a.depth_m - cosine * b.depth_m;
  const float b_m = b.depth_m - cosine * a.depth_m;
  if (a_m <= 0.0f) return set_one(support, b);
  if (b_m <= 0.0f || sine_squared < flat_sine_squared) return set_one(support, a);
  const float per_sine_squared = reciprocal(sine_squared);
  support.count = 0;
  support.add(a, per_sine_squared * a_m);
  support.add(b, per_sine_squared * b_m);
  support.out_m = support.depth_m[0] * a.normal + support.depth_m[1] * b.normal;
}

/// Sets the support of two barriers `a` and `b` and of a barrier `c` that excludes their point. Then `c` belongs to the
/// support. Nearly parallel barriers count as two.
void set_three(Support& support, const Barrier& a, const Barrier& b, const Barrier& c) {
  const Vector3 bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal), ab = cross(a.normal, b.normal);
  const float volume = dot(a.normal, bc);
  if (volume * volume > flat_sine_squared) {
    const float per_volume = volume > 0.0f ? reciprocal(volume) : -reciprocal(-volume);
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
/// have the sum 1, so that two parallel surfaces do not damp twice.
std::array<float, 3> damper_parts(const Support& support) {
  if (support.count == 1) return {1.0f, 0.0f, 0.0f};
  const auto [a, b, c] = support.barriers;
  const auto [a_m, b_m, c_m] = support.depth_m;
  const auto sine_squared = [](const Barrier& first, const Barrier& second) {
    const float cosine = dot(first.normal, second.normal);
    return 1.0f - cosine * cosine;
  };
  const float ab = sine_squared(*a, *b);
  if (support.count == 2) {
    const float per_sum = reciprocal(a_m + b_m);
    return {per_sum * (a_m + ab * b_m), per_sum * (b_m + ab * a_m), 0.0f};
  }
  const float ac = sine_squared(*a, *c), bc = sine_squared(*b, *c);
  const float per_sum = reciprocal(a_m + b_m + c_m);
  return {per_sum * (a_m + ab * b_m + ac * c_m), per_sum * (b_m + ab * a_m + bc * c_m),
          per_sum * (c_m + ac * a_m + bc * b_m)};
}

/// Friction and viscosity on the surface of the main barrier.
struct Tangential {
  Vector3 force_N;
  Vector3 lag_m;  ///< from the frictionless proxy to the proxy
  bool slides;
};

/// Below this square of a force the direction is undefined (1 uN).
constexpr float smallest_squared_N2 = 1e-12f;

/// Stick-slip friction (Salisbury et al., "Haptic rendering: programming touch interaction with virtual objects", I3D
/// 1995). `lag_m` and `velocity_m_per_s` are tangential. The lag of the previous proxy is a stretched spring.
Tangential friction(const Surface& surface, const Vector3& lag_m, const Vector3& velocity_m_per_s, float normal_N,
                    bool slides) {
  const Vector3 held_N = surface.stiffness_N_per_m * lag_m - surface.damping_Ns_per_m * velocity_m_per_s;
  const float held_squared_N2 = dot(held_N, held_N);
  const float bound_N = normal_N * (slides ? surface.dynamic_friction : surface.static_friction);
  if (held_squared_N2 <= bound_N * bound_N || held_squared_N2 <= smallest_squared_N2) return {held_N, lag_m, false};
  const Vector3 sliding_N = (surface.dynamic_friction * normal_N * reciprocal_square_root(held_squared_N2)) * held_N;
  return {sliding_N, surface.m_per_N * sliding_N, true};
}

[[gnu::cold]] Vector3 viscous_force_N(const Surface& surface, const Vector3& velocity_m_per_s, float normal_N) {
  const Vector3 force_N = -surface.viscosity_Ns_per_m * velocity_m_per_s;
  const float squared_N2 = dot(force_N, force_N);
  if (squared_N2 <= normal_N * normal_N || squared_N2 <= smallest_squared_N2) return force_N;
  return (normal_N * reciprocal_square_root(squared_N2)) * force_N;
}

}  // namespace

// Each pass adds the barrier that excludes the point most. At most three barriers remain.
void find_support(const Barriers& barriers, Support& support) {
  support.count = 0;
  const Barrier* next = deepest(barriers, zero);
  if (next == nullptr) return;
  set_one(support, *next);
  if (barriers.count == 1) return;
  next = deepest(barriers, support.out_m);
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

void Touch::follow(LocalModel& model) {
  model_ = &model;
  model_is_new_ = true;
}

bool Touch::age_model() {
  if (model_ == nullptr) return false;
  if (model_->life_periods == 0) {
    model_ = nullptr;
    return true;
  }
  --model_->life_periods;
  return false;
}

void Touch::add_model(const Vector3& probe_m) {
  constexpr float recovery_m = LocalModel::recovery_m_per_s * protocol::servo_period_s;
  // In a groove of two surfaces, the proxy moves faster than the surfaces.
  const float step_part = is_wedged_ ? 0.25f : 1.0f;
  for (std::size_t i = 0; i < model_->count; ++i) {
    Feature& feature = model_->features[i];
    feature.solid.centre_m = feature.solid.centre_m + protocol::servo_period_s * feature.velocity_m_per_s;
    feature.solid.axes[0] = feature.solid.axes[0] + protocol::servo_period_s * feature.axis_rate_per_s;
    Foot foot;
    if (!find_foot(feature.solid, proxy_m_, foot)) continue;
    float rise_m = 0.0f;
    if (model_is_new_) {
      feature.recess_m = foot.height_m < 0.0f ? -foot.height_m : 0.0f;
    } else if (feature.recess_m > 0.0f) {
      const float step_m = step_part * clamp(rise_N * feature.surface.m_per_N, 0.0f, recovery_m);
      rise_m = clamp(feature.recess_m, 0.0f, step_m);
      feature.recess_m -= rise_m;
    }
    const float depth_m = dot(foot.normal, proxy_m_ - probe_m) - foot.height_m - feature.recess_m;
    if (barriers_.is_in_reach(depth_m))
      barriers_.list[barriers_.count++] = {foot.normal, depth_m, &feature.surface, &feature.velocity_m_per_s,
                                           rise_m,      false};
  }
  model_is_new_ = false;
}

void Touch::collect(const Vector3& probe_m, const Box* walls, const Surface& wall) {
  barriers_.count = 0;
  if (walls != nullptr) {
    const Vector3 low_m = walls->minimum_m - probe_m, high_m = probe_m - walls->maximum_m;
    const std::array<float, 3> lows_m{low_m.x, low_m.y, low_m.z}, highs_m{high_m.x, high_m.y, high_m.z};
#pragma GCC unroll 1
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_low = lows_m[axis] > highs_m[axis];
      const float depth_m = is_low ? lows_m[axis] : highs_m[axis];
      if (!barriers_.is_in_reach(depth_m)) continue;
      const float sign = is_low ? 1.0f : -1.0f;
      const Vector3 normal{axis == 0 ? sign : 0.0f, axis == 1 ? sign : 0.0f, axis == 2 ? sign : 0.0f};
      barriers_.list[barriers_.count++] = {normal, depth_m, &wall, &zero, 0.0f, true};
    }
  }
  if (shapes.any_plane()) {
    // A loop without branches finds the touched planes.
    std::uint32_t below = 0;
    const auto height_m = [&](std::size_t i) {
      return dot(shapes.planes()[i].normal, probe_m) - shapes.planes()[i].offset_m;
    };
    for (std::size_t i = 0; i < Shapes::planes_maximum; ++i)
      below |= std::bit_cast<std::uint32_t>(height_m(i) - barriers_.reach_m) >> 31 << i;
#pragma GCC unroll 1
    for (std::size_t i = 0; below != 0; ++i, below >>= 1)
      if ((below & 1u) != 0 && barriers_.count < Barriers::maximum)
        barriers_.list[barriers_.count++] = {
            shapes.planes()[i].normal, -height_m(i), &shapes.surface_of_plane(i), &zero, 0.0f, false};
  }
  std::uint32_t solids = shapes.solids();
#pragma GCC unroll 1
  for (std::size_t i = 0; solids != 0; ++i, solids >>= 1) {
    if ((solids & 1u) == 0) continue;
    const Solid& solid = shapes.solid(i);
    const Vector3 from_centre_m = proxy_m_ - solid.centre_m;
    Foot foot;
    if (dot(from_centre_m, from_centre_m) > solid.reach_squared_m2 || !find_foot(solid, proxy_m_, foot)) continue;
    const float depth_m = dot(foot.normal, proxy_m_ - probe_m) - foot.height_m;
    if (barriers_.is_in_reach(depth_m))
      barriers_.list[barriers_.count++] = {foot.normal, depth_m, &shapes.surface_of_solid(i), &zero, 0.0f, false};
  }
  if (model_ != nullptr) add_model(probe_m);
}

const TouchForce& Touch::step(const Vector3& probe_m, const Vector3& velocity_m_per_s, const Box* walls,
                              const Surface& wall) {
  if (!touches_) proxy_m_ = probe_m;
  force_.walls_N = zero;
  force_.objects_N = zero;
  force_.raised_J = 0.0f;
  collect(probe_m, walls, wall);
  find_support(barriers_, support_);
  const Support& support = support_;
  touches_ = support.count != 0;
  is_wedged_ = support.count > 1;
  barriers_.reach_m = 0.0f;
  if (support.count == 0) {
    proxy_m_ = probe_m;
    return force_;
  }
  Vector3 normal_sum_N;
  float most_N = 0.0f;
  const Barrier* main = support.barriers[0];
  const auto parts = damper_parts(support);
  const auto add = [&](const Barrier& barrier, const Vector3& force_N) {
    Vector3& sum_N = barrier.is_wall ? force_.walls_N : force_.objects_N;
    sum_N = sum_N + force_N;
  };
#pragma GCC unroll 1
  for (std::size_t i = 0; i < support.count; ++i) {
    const Barrier& barrier = *support.barriers[i];
    barriers_.reach_m += support.depth_m[i];
    const float speed_m_per_s = dot(barrier.normal, velocity_m_per_s - *barrier.velocity_m_per_s);
    const float push_N = barrier.surface->stiffness_N_per_m * support.depth_m[i] -
                         parts[i] * barrier.surface->damping_Ns_per_m * speed_m_per_s;
    const float normal_N = push_N > 0.0f ? push_N : 0.0f;
    force_.raised_J += normal_N * barrier.rise_m;
    const Vector3 pushed_N = normal_N * barrier.normal;
    add(barrier, pushed_N);
    normal_sum_N = normal_sum_N + pushed_N;
    if (normal_N <= most_N) continue;
    most_N = normal_N;
    main = &barrier;
  }
  const Vector3 frictionless_m = probe_m + support.out_m;
  const Vector3 held_m = proxy_m_ + protocol::servo_period_s * *main->velocity_m_per_s;
  proxy_m_ = frictionless_m;
  const Surface& surface = *main->surface;
  const float squared_N2 = dot(normal_sum_N, normal_sum_N);
  if ((surface.static_friction == 0.0f && surface.viscosity_Ns_per_m == 0.0f) || squared_N2 < smallest_squared_N2)
    return force_;
  const float per_N = reciprocal_square_root(squared_N2);
  const Vector3 normal = per_N * normal_sum_N;
  const float normal_N = squared_N2 * per_N;
  const auto tangential = [&normal](const Vector3& vector) { return vector - dot(vector, normal) * normal; };
  const Vector3 sideways_m_per_s = tangential(velocity_m_per_s - *main->velocity_m_per_s);
  if (surface.static_friction != 0.0f) {
    const Tangential held = friction(surface, tangential(held_m - frictionless_m), sideways_m_per_s, normal_N, slides_);
    slides_ = held.slides;
    proxy_m_ = frictionless_m + held.lag_m;
    add(*main, held.force_N);
  }
  if (surface.viscosity_Ns_per_m != 0.0f) add(*main, viscous_force_N(surface, sideways_m_per_s, normal_N));
  return force_;
}

}  // namespace inkwell::control
