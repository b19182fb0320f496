// Three motors at rest with bridges and shunts.
#pragma once

#include <array>
#include <cmath>

#include "boards/omni_driver/facts.hpp"
#include "firmware/control/signal_path/vector.hpp"
#include "protocol/reports.hpp"

namespace inkwell::tests {

struct SimulatedMotor {
  float resistance_ohm = 2.27f;  ///< Omni motor with shunt and switches
  float inductance_H = 0.238e-3f;
  float dead_V = board::omni_driver.bridge_dead_time_part() * board::supply_nominal_V;
  float back_emf_V = 0.0f;
  float back_emf_V_per_s = 0.0f;
  float sensor_gain = 1.0f;
  std::size_t sensor = 0;  ///< index of the connected shunt, 0..2
  bool is_open = false;
  float current_A = 0.0f;
};

class SimulatedMotors {
 public:
  SimulatedMotors() {
    for (std::size_t i = 0; i < 3; ++i) motors[i].sensor = i;
  }

  /// Runs one control period. The voltages of the previous call are applied in this period; the new voltages are
  /// applied in the next period.
  control::Triple step(const control::Triple& requested_V) {
    control::Triple reading_A{};
    for (std::size_t i = 0; i < 3; ++i) {
      SimulatedMotor& motor = motors[i];
      reading_A[motor.sensor] += motor.sensor_gain * motor.current_A;
      advance(motor, acting_V_[i]);
    }
    acting_V_ = requested_V;
    return reading_A;
  }

  std::array<SimulatedMotor, 3> motors;

 private:
  // The dead time reduces the driving voltage and suppresses small voltages.
  static void advance(SimulatedMotor& motor, float voltage_V) {
    motor.back_emf_V += motor.back_emf_V_per_s * protocol::servo_period_s;
    if (motor.is_open) return;
    const float driving_V = voltage_V - motor.back_emf_V;
    const float size_V = std::fmax(std::fabs(driving_V) - motor.dead_V, 0.0f);
    const float final_A = std::copysign(size_V, driving_V) / motor.resistance_ohm;
    const float decay = std::exp(-protocol::servo_period_s * motor.resistance_ohm / motor.inductance_H);
    motor.current_A = final_A + (motor.current_A - final_A) * decay;
  }

  control::Triple acting_V_{};
};

}  // namespace inkwell::tests
