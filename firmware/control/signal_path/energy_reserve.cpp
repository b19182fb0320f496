#include "firmware/control/signal_path/energy_reserve.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

void EnergyReserve::update(const Vector3& felt_N, const Vector3& probe_m, const EnergyLimits& limits) {
  const float delivered_J = dot(felt_N, probe_m - position_m);
  position_m = probe_m;
  left_J = clamp(left_J + limits.refill_J_per_period - delivered_J, 0.0f, limits.reserve_J);
}

Vector3 without_drive(const Vector3& force_N, float power_W, const Vector3& velocity_m_per_s, float part) {
  constexpr float slow_squared = EnergyReserve::slow_m_per_s * EnergyReserve::slow_m_per_s;
  const float speed_squared = dot(velocity_m_per_s, velocity_m_per_s);
  return force_N - (part * power_W * reciprocal(speed_squared + slow_squared)) * velocity_m_per_s;
}

}  // namespace inkwell::control
