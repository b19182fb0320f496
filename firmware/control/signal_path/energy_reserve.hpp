// Passivity observer for the whole device. The observer reduces the force in order to limit the energy that the arm
// delivers.
//
// Walls, shapes and dampers return less energy than the hand puts into them. A program that pushes along the motion, a
// wrong force law or an oscillating loop could deliver energy indefinitely. The observer integrates the force over the
// measured motion of the probe to obtain the delivered energy. The method is from Hannaford and Ryu, "Time-domain
// passivity control of haptic interfaces", 2002. The remaining energy has a lower bound and an upper bound. Even after
// a long press into a wall, the force delivers at most the energy reserve to the hand. In addition, a small power may
// be delivered continuously.
#pragma once

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

struct EnergyLimits {
  float reserve_J;            ///< energy that may be delivered in advance
  float refill_J_per_period;  ///< energy that may be delivered in each period
  float low_reserves_per_J;   ///< 1 / energy below which the force is reduced
};

struct EnergyReserve {
  /// Below this part of the reserve, the driving component of the force is reduced. If the reserve is empty, the
  /// driving component is removed.
  static constexpr float low_part = 0.25f;
  /// Below this speed the motion of the probe has no reliable direction.
  static constexpr float slow_m_per_s = 0.02f;

  float left_J = 0.0f;
  Vector3 position_m;  ///< position of the probe in the previous period
};

/// Advances by one control period. Subtracts the work of the previous period's force, `felt_N`, on the path to
/// `position_m`. Adds the energy that may be delivered in each period.
void update_energy(EnergyReserve& reserve, const Vector3& felt_N, const Vector3& position_m,
                   const EnergyLimits& limits);

/// Returns the remaining energy, relative to the bound below which the force is reduced.
inline float part_left(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return reserve.left_J * limits.low_reserves_per_J;
}
inline bool is_low(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return part_left(reserve, limits) < 1.0f;
}

/// Fraction of the driving force component to remove, 0..1.
inline float driving_reduction(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return is_low(reserve, limits) ? 1.0f - part_left(reserve, limits) : 0.0f;
}

/// Removes `part` of the driving component from the force.
[[gnu::cold]] Vector3 without_drive(const Vector3& force_N, float power_W, const Vector3& velocity_m_per_s, float part);

}  // namespace inkwell::control
