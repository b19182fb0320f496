// Faults of a motor's shunt amplifier.
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

struct ShuntFault {
  enum class Output : std::uint8_t { follows, upper_rail, lower_rail, frozen };
  double offset_A = 0.0;
  double gain = 1.0;
  Output output = Output::follows;
  double frozen_V = 0.0;

  /// Returns the measured current of an amplifier that is not frozen.
  double read_A(double current_A) const { return gain * current_A + offset_A; }
};

}  // namespace inkwell::virtual_board
