// Inputs and outputs of the signal path.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// One reading of every sensor in SI units.
struct Samples {
  std::array<std::int32_t, 3> encoder_counts;  ///< counts since power-on, with timer wraps removed
  Triple current_A;                            ///< positive from leg A to leg B; includes the amplifier offsets
  Triple gimbal_ratio;                         ///< wiper voltage of each potentiometer relative to its supply, 0..1
  bool currents_measured;                      ///< all three currents were measured since the previous period
  float supply_V;                              ///< supply of the bridges
  std::uint8_t switches;                       ///< bits of protocol::Switch; 1 is closed, not debounced
  bool bridge_fault;                           ///< a bridge pulls the fault line
  std::uint32_t slow_age_periods;              ///< age of the last measurement of gimbal and supply
};

/// Commands to the bridges.
struct Drive {
  Triple duty{};         ///< mean voltage as a part of the supply, -1..1; positive drives leg A
  bool enabled = false;  ///< false switches all bridges off
  bool brake = false;    ///< all low sides are on while not enabled, so that the motors brake the arm (brake.hpp)
};

/// Ratings of the board.
struct BoardLimits {
  float supply_minimum_V;      ///< a lower supply voltage raises supply_low
  float supply_maximum_V;      ///< a higher supply voltage raises supply_high
  float duty_limit;            ///< largest magnitude of a duty cycle, 0..1
  float current_measurable_A;  ///< a higher current raises over_current, because a sensor may read too low
  float dead_time_part;        ///< voltage drop from the dead time of the bridges, as a part of the supply
  /// A single unfiltered supply reading beyond these bounds is a fault. Neither a load nor a braking arm moves the
  /// supply beyond these bounds.
  float supply_far_too_low_V = 0.5f * supply_minimum_V, supply_far_too_high_V = 1.1f * supply_maximum_V;
};

}  // namespace inkwell::control
