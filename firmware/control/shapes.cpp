#include <control/shapes.hpp>

#include <control/trigonometry.hpp>

namespace inkwell::control {

Vector3 surface_force_N(const Surface& surface, const Vector3& normal, float depth_m, const Vector3& probe_m,
                        const Vector3& velocity_m_per_s, Grip& grip) {
  const float normal_speed_m_per_s = dot(normal, velocity_m_per_s);
  const float spring_N = surface.stiffness_N_per_m * depth_m - surface.damping_Ns_per_m * normal_speed_m_per_s;
  const float normal_N = spring_N > 0.0f ? spring_N : 0.0f;
  if (surface.static_friction == 0.0f) return normal_N * normal;
  if (!grip.holds) {
    grip = {probe_m, true, false};
    return normal_N * normal;
  }
  const Vector3 away_m = grip.point_m - probe_m;
  const Vector3 slip_m = away_m - dot(away_m, normal) * normal;
  const Vector3 slip_m_per_s = velocity_m_per_s - normal_speed_m_per_s * normal;
  const Vector3 held_N = surface.stiffness_N_per_m * slip_m - surface.damping_Ns_per_m * slip_m_per_s;
  const float held_squared_N2 = dot(held_N, held_N);
  const float bound_N = normal_N * (grip.slides ? surface.dynamic_friction : surface.static_friction);
  grip.slides = held_squared_N2 > bound_N * bound_N;
  // Below a micronewton there is no direction to slide in.
  constexpr float smallest_squared_N2 = 1e-12f;
  if (!grip.slides || held_squared_N2 < smallest_squared_N2) return normal_N * normal + held_N;
  const Vector3 sliding_N = (surface.dynamic_friction * normal_N * reciprocal_square_root(held_squared_N2)) * held_N;
  grip.point_m = probe_m + surface.m_per_N * sliding_N;
  return normal_N * normal + sliding_N;
}

void TouchedShapes::replace(const Shapes& shapes) {
  shapes_ = &shapes;
  age_periods_ = 0;
  for (std::size_t i = 0; i < grips_.size(); ++i)
    if (shapes.life_periods[i] == 0) grips_[i].holds = false;
  list_alive();
}

bool TouchedShapes::age() {
  if (next_end_periods_ == 0 || ++age_periods_ != next_end_periods_) return false;
  list_alive();
  return true;
}

void TouchedShapes::list_alive() {
  next_end_periods_ = 0;
  planes_alive_ = 0;
  const auto lives = [this](std::size_t shape) {
    const std::uint32_t end_periods = shapes_->life_periods[shape];
    if (end_periods <= age_periods_) return false;
    if (next_end_periods_ == 0 || end_periods < next_end_periods_) next_end_periods_ = end_periods;
    return true;
  };
  sphere_lives_ = lives(0);
  for (std::uint8_t plane = 0; plane < shapes_->planes.size(); ++plane)
    if (lives(1u + plane)) alive_[planes_alive_++] = plane;
}

Vector3 TouchedShapes::force_N(const Vector3& probe_m, const Vector3& velocity_m_per_s) {
  Vector3 force_N;
  for (std::size_t i = 0; i < planes_alive_; ++i) {
    const std::size_t place = alive_[i];
    const Plane& plane = shapes_->planes[place];
    const float depth_m = plane.offset_m - dot(plane.normal, probe_m);
    if (depth_m > 0.0f)
      force_N = force_N + surface_force_N(shapes_->surfaces[1 + place], plane.normal, depth_m, probe_m,
                                          velocity_m_per_s, grips_[1 + place]);
    else
      grips_[1 + place].holds = false;
  }
  if (!sphere_lives_) return force_N;
  const Sphere& sphere = shapes_->sphere;
  const Vector3 out_m = probe_m - sphere.centre_m;
  const float squared_m2 = dot(out_m, out_m);
  // At the centre no way out is shorter than another.
  constexpr float smallest_squared_m2 = 1e-14f;
  if (squared_m2 >= sphere.radius_squared_m2 || squared_m2 < smallest_squared_m2) {
    grips_[0].holds = false;
    return force_N;
  }
  const float per_distance = reciprocal_square_root(squared_m2);
  return force_N + surface_force_N(shapes_->surfaces[0], per_distance * out_m,
                                   sphere.radius_m - squared_m2 * per_distance, probe_m, velocity_m_per_s, grips_[0]);
}

}  // namespace inkwell::control
