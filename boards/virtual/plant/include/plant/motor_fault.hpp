// What may be wrong with a motor's winding.
#pragma once

namespace inkwell::virtual_board {

struct MotorFault {
  // Copper, and the ferrite magnets of a small motor.
  static constexpr double resistance_per_K = 0.00393, torque_constant_per_K = -0.002;

  bool open = false;
  double turns_left = 1.0;  ///< share that is not shorted
  double warmer_K = 0.0;

  double resistance_factor() const { return turns_left * (1.0 + resistance_per_K * warmer_K); }
  /// The inductance goes with the square of the turns.
  double inductance_factor() const { return turns_left * turns_left; }
  double torque_factor() const { return turns_left * (1.0 + torque_constant_per_K * warmer_K); }
};

}  // namespace inkwell::virtual_board
