// Passivity observer on the whole device. The observer limits the energy that the arm delivers by reducing the force.
//
// Walls, shapes and dampers return less energy than the hand puts into them. A program that pushes along the motion, a
// wrong force law or an oscillating loop delivers more energy for as long as it runs. The observer integrates the
// energy that the force delivers over the measured motion of the probe. The method is from Hannaford and Ryu,
// "Time-domain passivity control of haptic interfaces", 2002. The sum is bounded on both sides. After a long press, the
// force returns at most the reserve to the hand. A small power may be delivered continuously.
#pragma once

#include <control/vector.hpp>

namespace inkwell::control {

struct EnergyLimits {
  float reserve_J;           ///< energy that may be delivered in advance
  float given_J_per_period;  ///< energy that may be delivered in each period
  float low_reserves_per_J;  ///< 1 / energy below which the force is reduced
};

struct EnergyReserve {
  /// Below this part of the reserve, the driving component of the force is reduced. With an empty reserve this
  /// component is removed.
  static constexpr float low_part = 0.25f;
  /// Below this speed the motion of the probe has no reliable direction.
  static constexpr float slow_m_per_s = 0.02f;

  float left_J = 0.0f;
  Vector3 position_m;  ///< position of the probe in the previous period
};

/// Advances by one control period. Subtracts the work of `felt_N`, the force of the previous period, on the path to
/// `position_m`. Adds the energy that may be delivered continuously.
void account(EnergyReserve& reserve, const Vector3& felt_N, const Vector3& position_m, const EnergyLimits& limits);

/// Remaining energy divided by the energy below which the force is reduced.
inline float part_left(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return reserve.left_J * limits.low_reserves_per_J;
}
inline bool is_low(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return part_left(reserve, limits) < 1.0f;
}

/// Part of the driving force component to remove, 0..1.
inline float gives_way(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return is_low(reserve, limits) ? 1.0f - part_left(reserve, limits) : 0.0f;
}

/// Removes `part` of the driving component from the force.
[[gnu::cold]] Vector3 without_drive(const Vector3& force_N, float power_W, const Vector3& velocity_m_per_s, float part);

}  // namespace inkwell::control
