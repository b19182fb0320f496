// Motor heat, computed from the measured currents.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

struct HeatScale {
  Triple per_square_sum;     ///< converts a sum of squares to the steady-state heat
  float winding_part;        ///< part of the total rise in the winding; the rest is in the housing
  float winding_per_update;  ///< part of the difference from the steady state that decays in one update of the winding
  float housing_per_update;
};

/// Temperature rise of each winding above room temperature, relative to the steady-state rise at its continuous
/// current. The rise is the sum of two temperature differences: winding to housing (fast) and housing to room (slow).
/// The squared current increases both differences. Each difference decays with a separate time constant. At power-on
/// the motors are assumed to be cold. After any other restart, the motor heat is unchanged.
struct MotorHeat {
  /// Number of readings per heat update. The heat increment of one reading is below the resolution of a float.
  static constexpr std::uint32_t readings_per_update = 128;
  static constexpr std::uint32_t periods_per_update = 3 * readings_per_update;
  Triple heat{};
  Triple beyond{};       ///< heat above motor_heat_limits_from
  bool too_hot = false;  ///< set at motor_heat_fault, cleared when all motors are below motor_heat_limits_from
  Triple housing{};      ///< part of the heat
  Triple square_sum_A2{};
  std::uint32_t readings = 0;  ///< number of readings in each sum

  /// Runs one control period for one motor. Successive calls use `motor` 0, 1, 2, 0 and so on.
  void update(std::size_t motor, float current_A, const HeatScale& scale);

 private:
  void warm(std::size_t motor, const HeatScale& scale);
  void hold_back(std::size_t motor);
  void judge();
};

/// Motor heat that survives a restart. Start-up does not initialize this struct.
struct Warmth {
  Triple heat, housing;
  std::uint32_t too_hot;  ///< 0 or 1
};

}  // namespace inkwell::control
