// How warm the windings are, from the currents that were measured in them.
#pragma once

#include <cstddef>
#include <cstdint>

#include <control/vector.hpp>

namespace inkwell::control {

/// Temperature rise of each winding over its housing, in parts of the rise that its continuous current leads
/// to. A winding warms with the square of its current and cools with one time constant; the housing's own,
/// fifty times longer, is left out, so a motor that has been hot for minutes is warmer than this says.
struct MotorHeat {
  /// Squares are gathered over so many readings: in a single one the heat grows by less than a float resolves.
  static constexpr std::uint32_t readings_per_update = 128;
  static constexpr std::uint32_t periods_per_update = 3 * readings_per_update;
  Triple heat{};
  Triple square_sum_A2{};
  std::uint32_t readings = 0;  ///< in each sum
};

struct HeatScale {
  Triple per_square_sum;  ///< makes the heat of a lasting current from the sum of its squares
  float weight;           ///< part of the way to it that the heat goes in one update
};

/// One control period. The motors take turns: `motor` is 0, 1, 2, 0 and so on.
void update_heat(MotorHeat& motors, std::size_t motor, float current_A, const HeatScale& scale);

}  // namespace inkwell::control
