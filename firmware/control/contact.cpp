#include <control/contact.hpp>

#include <control/trigonometry.hpp>

namespace inkwell::control {

namespace {

/// k d + c d' along one axis, signed; `penetration_m` points out of the wall.
float axis_force_N(float penetration_m, float velocity_m_per_s, const Wall& wall) {
  if (penetration_m == 0.0f) return 0.0f;
  const float force_N = wall.stiffness_N_per_m * penetration_m - wall.damping_Ns_per_m * velocity_m_per_s;
  const bool pulls = force_N * penetration_m < 0.0f;
  return pulls ? 0.0f : force_N;
}

}  // namespace

Contact find_contact(const Vector3& probe_m, const Box& box) {
  const Vector3 proxy_m{clamp(probe_m.x, box.minimum_m.x, box.maximum_m.x),
                        clamp(probe_m.y, box.minimum_m.y, box.maximum_m.y),
                        clamp(probe_m.z, box.minimum_m.z, box.maximum_m.z)};
  return {proxy_m, proxy_m - probe_m};
}

Vector3 wall_force_N(const Contact& contact, const Vector3& velocity_m_per_s, const Wall& wall) {
  const Vector3& out_m = contact.penetration_m;
  return {axis_force_N(out_m.x, velocity_m_per_s.x, wall), axis_force_N(out_m.y, velocity_m_per_s.y, wall),
          axis_force_N(out_m.z, velocity_m_per_s.z, wall)};
}

Force bounded(const Vector3& force_N, float limit_N) {
  // Below a micronewton there is no direction to keep, and the reciprocal root would leave its range.
  constexpr float smallest_squared_N2 = 1e-12f;
  const float squared_N2 = dot(force_N, force_N);
  if (squared_N2 < smallest_squared_N2) return {};
  const float per_magnitude = reciprocal_square_root(squared_N2);
  const float magnitude_N = squared_N2 * per_magnitude;
  if (magnitude_N <= limit_N) return {force_N, magnitude_N};
  return {(limit_N * per_magnitude) * force_N, limit_N};
}

}  // namespace inkwell::control
