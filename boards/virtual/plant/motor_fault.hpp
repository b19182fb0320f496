// Faults of a motor winding.
#pragma once

namespace inkwell::virtual_board {

struct MotorFault {
  // Temperature coefficients of copper and ferrite magnets.
  static constexpr double resistance_per_K = 0.00393, torque_constant_per_K = -0.002;

  bool open = false;
  double turns_left = 1.0;  ///< fraction of the turns that is not shorted
  double warmer_K = 0.0;

  double resistance_factor() const { return turns_left * (1.0 + resistance_per_K * warmer_K); }
  /// The inductance is proportional to the square of the number of turns.
  double inductance_factor() const { return turns_left * turns_left; }
  double torque_factor() const { return turns_left * (1.0 + torque_constant_per_K * warmer_K); }
};

}  // namespace inkwell::virtual_board
