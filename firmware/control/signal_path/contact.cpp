#include "firmware/control/signal_path/contact.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

Contact find_contact(const Vector3& probe_m, const Box& box) {
  const Vector3 proxy_m{clamp(probe_m.x, box.minimum_m.x, box.maximum_m.x),
                        clamp(probe_m.y, box.minimum_m.y, box.maximum_m.y),
                        clamp(probe_m.z, box.minimum_m.z, box.maximum_m.z)};
  return {proxy_m, proxy_m - probe_m};
}

Force bounded(Vector3 force_N, float limit_N) {
  // Below 1 uN the force has no reliable direction.
  constexpr float smallest_squared_N2 = 1e-12f;
  const float squared_N2 = dot(force_N, force_N);
  if (squared_N2 < smallest_squared_N2) return {};
  const float per_magnitude = reciprocal_square_root(squared_N2);
  const float magnitude_N = squared_N2 * per_magnitude;
  if (magnitude_N <= limit_N) return {force_N, magnitude_N};
  return {(limit_N * per_magnitude) * force_N, limit_N};
}

}  // namespace inkwell::control
