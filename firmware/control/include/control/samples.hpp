// What the control path takes from the board and gives back to it in every control period.
#pragma once

#include <array>
#include <cstdint>

#include <control/vector.hpp>

namespace inkwell::control {

/// One reading of every sensor, scaled to SI units by the drivers.
struct Samples {
  std::array<std::int32_t, 3> encoder_counts;  ///< since power-up, wraps of the timers undone
  Triple current_A;                ///< positive from leg A to leg B; the amplifiers' offsets are still inside
  Triple gimbal_ratio;             ///< voltage of each potentiometer as a part of its supply, 0..1
  bool currents_measured;          ///< all three of them, since the period before
  float supply_V;                  ///< of the bridges
  std::uint8_t switches;           ///< bits of protocol::Switch, 1 is closed, not debounced
  bool bridge_fault;               ///< a bridge pulls the fault line
  std::uint32_t slow_age_periods;  ///< since gimbal and supply were measured
};

/// What the bridges are told.
struct Drive {
  Triple duty{};         ///< mean voltage as a part of the supply, -1..1, positive drives leg A
  bool enabled = false;  ///< false switches all bridges off
  bool brake = false;    ///< not enabled, but all low sides on: the motors brake the arm (control/brake.hpp)
};

/// What the board can bear and do. A fact of the board, so the application hands it in.
struct BoardLimits {
  float supply_minimum_V;      ///< below it: fault supply_low
  float supply_maximum_V;      ///< above it: fault supply_high
  float duty_limit;            ///< largest magnitude of a duty, 0..1
  float current_measurable_A;  ///< beyond it a sensor may show less than there is: fault over_current
  float dead_time_part;        ///< of the supply: what the bridges' dead time takes from a motor's voltage
  /// One reading beyond these is a fault at once, without the filter: no load makes a supply dip so far, and no arm
  /// that is braked lifts it so far.
  float supply_far_too_low_V = 0.5f * supply_minimum_V, supply_far_too_high_V = 1.1f * supply_maximum_V;
};

}  // namespace inkwell::control
