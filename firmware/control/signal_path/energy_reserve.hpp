// Passivity observer for the whole device. The observer reduces the force in order to limit the energy that the arm
// delivers.
//
// Walls, shapes and dampers return less energy than the hand supplies. A wrong force law or an unstable program could
// deliver energy indefinitely. The delivered energy is the integral of the force over the measured probe motion. The
// method is from Hannaford and Ryu, "Time-domain passivity control of haptic interfaces", 2002. Energy from the hand
// refills the reserve only up to `reserve_J`. A small continuous power refills the reserve.
#pragma once

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

struct EnergyLimits {
  float reserve_J;            ///< energy that may be delivered in advance
  float refill_J_per_period;  ///< energy that may be delivered in each period
  float low_reserves_per_J;   ///< 1 / energy below which the force is reduced
};

struct EnergyReserve {
  /// Below this fraction of the reserve, the force component along the motion is reduced. With an empty reserve, the
  /// force component along the motion is zero.
  static constexpr float low_part = 0.25f;
  /// Below this speed the motion of the probe has no reliable direction.
  static constexpr float slow_m_per_s = 0.02f;

  float left_J = 0.0f;
  Vector3 position_m;  ///< position of the probe in the previous period

  /// Advances by one control period. Subtracts the work of the previous force `felt_N` on the path to `probe_m`.
  /// Adds `refill_J_per_period`.
  void update(const Vector3& felt_N, const Vector3& probe_m, const EnergyLimits& limits);

  /// Subtracts energy that a moving surface stores in its spring.
  void spend(float energy_J) { left_J = left_J > energy_J ? left_J - energy_J : 0.0f; }

  /// Returns the remaining energy divided by the energy below which the force is reduced.
  float part_left(const EnergyLimits& limits) const { return left_J * limits.low_reserves_per_J; }
  bool is_low(const EnergyLimits& limits) const { return part_left(limits) < 1.0f; }
  /// Returns the fraction (0..1) by which the force component along the motion is reduced.
  float driving_reduction(const EnergyLimits& limits) const { return is_low(limits) ? 1.0f - part_left(limits) : 0.0f; }
};

/// Reduces the force component along the motion by the fraction `part`.
[[gnu::cold]] Vector3 without_drive(const Vector3& force_N, float power_W, const Vector3& velocity_m_per_s, float part);

}  // namespace inkwell::control
