// How warm the motors are, from the currents that were measured in them, and how much too warm for all of their current
// limit.
#pragma once

#include <cstddef>
#include <cstdint>

#include <control/vector.hpp>

namespace inkwell::control {

/// Temperature rise of each winding over the room, in parts of the rise that its continuous current leads to: that of
/// the winding over its housing, quick, and that of the housing over the room, slow. Both warm with the square of the
/// current and cool with a time constant of their own. A board whose power comes takes its motors for cold; over any
/// other restart their Warmth is kept, and does not cool meanwhile.
struct MotorHeat {
  /// Squares are gathered over so many readings: in a single one the heat grows by less than a float resolves.
  static constexpr std::uint32_t readings_per_update = 128;
  static constexpr std::uint32_t periods_per_update = 3 * readings_per_update;
  Triple heat{};
  Triple beyond{};  ///< of the heat above motor_heat_holds_back_from
  bool too_hot =
      false;         ///< one has reached motor_heat_fault, and not all have cooled to motor_heat_holds_back_from since
  Triple housing{};  ///< part of the heat
  Triple square_sum_A2{};
  std::uint32_t readings = 0;  ///< in each sum
};

/// What of MotorHeat a restart must not forget. Without initial values, for memory that start-up does not clear.
struct Warmth {
  Triple heat, housing;
  std::uint32_t too_hot;  ///< 0 or 1
};

struct HeatScale {
  Triple per_square_sum;     ///< makes the heat of a lasting current from the sum of its squares
  float winding_part;        ///< of the whole rise; the rest is the housing's
  float winding_per_update;  ///< part of the way to its lasting rise that the winding goes in one update
  float housing_per_update;
};

/// One control period. The motors take turns: `motor` is 0, 1, 2, 0 and so on.
void update_heat(MotorHeat& motors, std::size_t motor, float current_A, const HeatScale& scale);

}  // namespace inkwell::control
