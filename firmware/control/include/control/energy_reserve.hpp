// What the arm may give the hand: a passivity observer on the whole device, and what gives way when it says so.
//
// Walls, shapes and dampers give back less than the hand put into them, whatever they look like. A program that pushes
// along with the motion, a law that is wrong, or a loop that rings gives more, for as long as it runs. The energy that
// the force gave the hand is summed over the true way of the probe (Hannaford and Ryu, "Time-domain passivity control
// of haptic interfaces", 2002); the sum is kept from growing without end on either side: a hand that pressed for long
// gets no more back than the reserve, and a small power may be given for ever.
#pragma once

#include <control/vector.hpp>

namespace inkwell::control {

struct EnergyLimits {
  float reserve_J;           ///< what may be given ahead
  float given_J_per_period;  ///< what may be given for ever
  float low_reserves_per_J;  ///< 1 over the energy below which the force gives way
};

struct EnergyReserve {
  /// From this part of the reserve on, the part of the force that drives the motion gives way, all of it at none.
  static constexpr float low_part = 0.25f;
  /// A probe that is slower has no direction in which to give way.
  static constexpr float slow_m_per_s = 0.02f;

  float left_J = 0.0f;
  Vector3 position_m;  ///< of the probe, in the period before
};

/// One control period: takes out what `felt_N`, the force of the period before, gave on the way to `position_m`, and
/// puts in what may be given for ever.
void account(EnergyReserve& reserve, const Vector3& felt_N, const Vector3& position_m, const EnergyLimits& limits);

/// What is left, in parts of the energy below which the force gives way.
inline float part_left(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return reserve.left_J * limits.low_reserves_per_J;
}
inline bool is_low(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return part_left(reserve, limits) < 1.0f;
}

/// The part of what drives the motion that has to give way, 0..1.
inline float gives_way(const EnergyReserve& reserve, const EnergyLimits& limits) {
  return is_low(reserve, limits) ? 1.0f - part_left(reserve, limits) : 0.0f;
}

/// The force without so large a part of what drives the motion.
[[gnu::cold]] Vector3 without_drive(const Vector3& force_N, float power_W, const Vector3& velocity_m_per_s, float part);

}  // namespace inkwell::control
