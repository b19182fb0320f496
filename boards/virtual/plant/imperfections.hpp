// Typical imperfections of a real driver board, from data sheets. The nominal values are in the board facts and in the
// arm description.
#pragma once

#include <array>

namespace inkwell::virtual_board {

struct Imperfections {
  // Bridges
  double leg_resistance_ohm = 0.03;  ///< of one closed switch
  double diode_drop_V = 0.8;

  // Shunt amplifiers
  std::array<double, 3> amplifier_offset_V = {0.0021, -0.0034, 0.0012};  ///< at the output
  std::array<double, 3> amplifier_gain_error = {0.002, -0.003, 0.001};
  double amplifier_noise_V = 0.0008;  ///< rms at the output
  double amplifier_bandwidth_Hz = 400e3;

  // Supply
  double source_resistance_ohm = 0.15;
  double bulk_capacitance_F = 2200e-6;
  double quiescent_resistance_ohm = 300.0;  ///< load of bridges and regulator
  double supply_reading_noise_V = 0.0008;   ///< rms at the pin

  // Gimbal
  double wiper_noise_V = 0.0012;  ///< rms at the pin
};

}  // namespace inkwell::virtual_board
