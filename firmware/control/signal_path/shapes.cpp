#include "firmware/control/signal_path/shapes.hpp"

#include <bit>

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

/// Plane for an unused entry. Every point is in the free space of this plane.
constexpr Plane nowhere{.normal = {}, .offset_m = -1.0f};

float height_m(const Plane& plane, const Vector3& probe_m) { return dot(plane.normal, probe_m) - plane.offset_m; }

}  // namespace

Vector3 surface_force_N(const Surface& surface, const Vector3& normal, float depth_m, const Vector3& probe_m,
                        const Vector3& velocity_m_per_s, Grip& grip, bool is_new) {
  const float normal_speed_m_per_s = dot(normal, velocity_m_per_s);
  const float spring_N = surface.stiffness_N_per_m * depth_m - surface.damping_Ns_per_m * normal_speed_m_per_s;
  const float normal_N = spring_N > 0.0f ? spring_N : 0.0f;
  const Vector3 pushed_N = normal_N * normal;
  if (surface.static_friction == 0.0f) return pushed_N;
  if (is_new) {
    grip.point_m = probe_m;
    grip.slides = false;
    return pushed_N;
  }
  const Vector3 away_m = grip.point_m - probe_m;
  // The spring and damper force is projected onto the surface.
  const Vector3 pull_N = surface.stiffness_N_per_m * away_m - surface.damping_Ns_per_m * velocity_m_per_s;
  const Vector3 held_N = pull_N - dot(pull_N, normal) * normal;
  const float held_squared_N2 = dot(held_N, held_N);
  const float bound_N = normal_N * (grip.slides ? surface.dynamic_friction : surface.static_friction);
  // Below 1 uN the sliding direction is undefined.
  constexpr float smallest_squared_N2 = 1e-12f;
  grip.slides = held_squared_N2 > bound_N * bound_N && held_squared_N2 > smallest_squared_N2;
  if (!grip.slides) return pushed_N + held_N;
  const Vector3 sliding_N = (surface.dynamic_friction * normal_N * reciprocal_square_root(held_squared_N2)) * held_N;
  grip.point_m = probe_m + surface.m_per_N * sliding_N;
  return pushed_N + sliding_N;
}

void TouchedShapes::replace(const Shapes& shapes) {
  shapes_ = &shapes;
  age_periods_ = 0;
  list_alive();
}

bool TouchedShapes::age() {
  if (next_end_periods_ == 0 || ++age_periods_ != next_end_periods_) return false;
  list_alive();
  return true;
}

void TouchedShapes::list_alive() {
  next_end_periods_ = 0;
  any_plane_lives_ = false;
  const auto lives = [this](std::size_t shape) {
    const std::uint32_t end_periods = shapes_->life_periods[shape];
    if (end_periods <= age_periods_) {
      touched_ &= ~(1u << shape);
      return false;
    }
    const bool ends_next = next_end_periods_ == 0 || end_periods < next_end_periods_;
    if (end_periods != Shapes::lasting && ends_next) next_end_periods_ = end_periods;
    return true;
  };
  sphere_lives_ = lives(0);
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const bool is_there = lives(1 + i);
    planes_[i] = is_there ? shapes_->planes[i] : nowhere;
    any_plane_lives_ |= is_there;
  }
}

Vector3 TouchedShapes::force_N(const Vector3& probe, const Vector3& velocity_m_per_s) {
  const Vector3 probe_m = probe;  // local copy that stays in registers during stores
  // A loop without branches finds the touched planes.
  std::uint32_t planes_below = 0;
  for (std::size_t i = 0; i < planes_.size(); ++i)
    planes_below |= std::bit_cast<std::uint32_t>(height_m(planes_[i], probe_m)) >> 31 << i;
  Vector3 force_N;
  std::uint32_t touched = 0;
  const auto add_contact = [&](std::size_t number, const Vector3& normal, float depth_m) {
    const bool is_new = (touched_ >> number & 1u) == 0;
    force_N = force_N + surface_force_N(shapes_->surfaces[number], normal, depth_m, probe_m, velocity_m_per_s,
                                        grips_[number], is_new);
    touched |= 1u << number;
  };
  for (std::size_t i = 0; planes_below != 0 && i < planes_.size(); ++i)
    if ((planes_below >> i & 1u) != 0) add_contact(1 + i, planes_[i].normal, -height_m(planes_[i], probe_m));
  if (sphere_lives_) {
    const Sphere& sphere = shapes_->sphere;
    const Vector3 out_m = probe_m - sphere.centre_m;
    const float squared_m2 = dot(out_m, out_m);
    // At the center of the sphere, the outward direction is undefined.
    constexpr float smallest_squared_m2 = 1e-14f;
    if (squared_m2 < sphere.radius_squared_m2 && squared_m2 > smallest_squared_m2) {
      const float per_distance = reciprocal_square_root(squared_m2);
      add_contact(0, per_distance * out_m, sphere.radius_m - squared_m2 * per_distance);
    }
  }
  touched_ = touched;
  return force_N;
}

}  // namespace inkwell::control
