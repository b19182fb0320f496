// Resistance and inductance of a motor from its answers to pulses of voltage. Pure: samples in, numbers out.
//
// The circuit is  u = R i + L di/dt + e + s(i) U,  sampled once a control period:
//   u  duty times supply, constant over a period; it acts one period after it was computed
//   e  back-EMF of the motor while the arm gives way: torque constant times motor speed
//   U  what the bridges' dead time takes away, with the sign of the current; while the current is smaller than
//      its ripple the sign changes within the period and only a part of it is lost
// Between two samples the current moves by the exact solution, exp(-R T / L). The fit looks at the pulse from its
// second sample on with the first current as an unknown of its own, so that neither the delay nor what happens
// around zero current can disguise itself as inductance; the delay comes out as a figure of its own.
#pragma once

#include <cstddef>
#include <vector>

namespace inkwell::guides {

/// Consecutive control periods that hold one pulse of voltage and at least two periods before it.
struct VoltagePulse {
  std::vector<double> voltage_V;   ///< duty times supply, as the firmware computed it
  std::vector<double> current_A;   ///< measured
  std::vector<double> back_emf_V;  ///< torque constant times speed of the motor
};

struct MotorCircuit {
  double resistance_ohm = 0;  ///< of the whole circuit: winding, shunt and both switches of the bridge
  double inductance_H = 0;
  double dead_time_voltage_V = 0;
  double delay_s = 0;     ///< from the sample that computed a voltage to its effect
  double residual_A = 0;  ///< root mean square of measured less fitted current
};

/// Current ripple below which the loss by dead time is proportional to the current: half its peak to peak.
/// Throws device::Error if there is no pulse, no current, or the currents do not follow such a circuit.
MotorCircuit identify(const std::vector<VoltagePulse>& pulses, double sample_period_s, double ripple_A);

struct SuggestedGains {
  double proportional_V_per_A = 0;
  double integral_V_per_As = 0;
};

/// Pole-zero cancellation: with Kp = L w and Ki = R w the open loop is w / s, whose closed loop has the bandwidth w
/// and no overshoot but for the delay (see for example Harnefors and Nee, "Model-based current control of AC
/// machines using the internal model control method", IEEE Trans. Ind. Appl. 34(1), 1998).
SuggestedGains suggest_gains(const MotorCircuit& motor, double bandwidth_Hz);

/// Phase that the delay leaves at the bandwidth: 90 degrees less w times the delay.
double phase_margin_deg(double bandwidth_Hz, double delay_s);

}  // namespace inkwell::guides
