// Computes resistance and inductance of a motor from voltage pulses.
//
// The circuit is  u = R i + L di/dt + e + s(i) U,  sampled once per control period.
//   `u`  Duty times supply, constant over a period. The voltage acts one period after its computation.
//   `e`  Back-EMF of the motor while the arm moves: torque constant times motor speed.
//   `U`  Voltage loss due to the bridges' dead time, with the sign of the current. For currents smaller than the
//        ripple, the sign changes within a period, and only a part of U is lost.
// Between two samples the current follows the exact solution, exp(-R T / L). The fit starts at the second sample of the
// pulse, with the first current as an additional unknown. The delay and the nonlinearity around zero current therefore
// do not affect the inductance. The delay is a separate result.
#pragma once

#include <cstddef>
#include <vector>

namespace inkwell::guides {

/// Consecutive control periods with one voltage pulse and at least two periods before the pulse.
struct VoltagePulse {
  std::vector<double> voltage_V;   ///< duty times supply, as computed by the firmware
  std::vector<double> current_A;   ///< measured
  std::vector<double> back_emf_V;  ///< torque constant times speed of the motor
};

struct MotorCircuit {
  double resistance_ohm = 0;  ///< of the complete circuit: winding, shunt and both bridge switches
  double inductance_H = 0;
  double dead_time_voltage_V = 0;
  double delay_s = 0;     ///< from the sample on which a voltage is based to the effect of this voltage
  double residual_A = 0;  ///< root mean square of measured minus fitted current
};

/// `ripple_A` is half the peak-to-peak current ripple. Below `ripple_A` the dead-time loss is proportional to the
/// current. Throws device::Error if the samples contain no pulse or no current, or if the currents contradict the
/// circuit.
MotorCircuit identify(const std::vector<VoltagePulse>& pulses, double sample_period_s, double ripple_A);

struct SuggestedGains {
  double proportional_V_per_A = 0;
  double integral_V_per_As = 0;
};

/// Pole-zero cancellation: with Kp = L w and Ki = R w the open loop is w / s. The closed loop has the bandwidth w and
/// no overshoot except for the effect of the delay. See for example Harnefors and Nee, "Model-based current control of
/// AC machines using the internal model control method", IEEE Trans. Ind. Appl. 34(1), 1998.
SuggestedGains suggest_gains(const MotorCircuit& motor, double bandwidth_Hz);

/// Phase margin at the bandwidth: 90 degrees minus w times the delay.
double phase_margin_deg(double bandwidth_Hz, double delay_s);

}  // namespace inkwell::guides
