// Checks that voltage, current and speed of a motor are consistent.
//
// The motor equation is u = R i + k w. The voltage u is the bridge command, the current i comes from the shunt, and the
// speed w comes from the encoder. If a current reading is frozen, too small or from another motor, the current loop
// applies an unexplained voltage. An open motor and a stuck bridge leg also cause an unexplained voltage. A voltage
// below R i + k w indicates shorted turns or an excessive current reading.
//
// Both sides of the motor equation are compared while the current loops drive the bridges. Differences beyond the
// tolerance of a healthy motor are integrated over time. The neglected inductance adds at most L di to the integral.
// Large differences are therefore detected sooner than small differences.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "firmware/control/signal_path/current_loop.hpp"
#include "firmware/control/signal_path/vector.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Voltage model of a healthy motor.
struct MotorModel {
  Triple resistance_ohm;  ///< from the parameters
  /// Back EMF per joint speed, negative for a reversed motor.
  Triple back_emf_Vs_per_rad;
  bool is_confirmed;  ///< a missing or unknown motor fails the self-test
};

/// Voltage drop of a bridge. Above MotorCheck::steady_A, the voltage drop opposes the current.
struct BridgeLoss {
  float measured_V;  ///< from the self-test, including brushes; 0 if unknown
  float most_V;      ///< from the dead time of the bridge

  constexpr float least_V() const { return measured_V < most_V ? measured_V : most_V; }
  constexpr float expected_V() const { return measured_V > 0.0f ? measured_V : most_V; }
};

/// Self-test measurements of motors and bridges. Each value comes from the last conclusive test.
struct MeasuredMotors {
  Triple bridge_loss_part{};   ///< voltage drop of bridge and brushes, as a part of the supply; 0 if unknown
  Triple resistance_ohm{};     ///< measured resistance; 0 if unknown
  Triple heat{};               ///< heat at the resistance measurement (MotorHeat)
  bool awaits_motors = false;  ///< a motor is missing or unknown, so no motor receives current for the force
};

/// Assumed resistance of a motor.
struct Resistance {
  /// Tolerance above a measured resistance. The tolerance covers an error of 50 K in the heat model.
  static constexpr float tolerated_increase_if_measured = 0.2f;
  /// Tolerance above the resistance parameter. A rise of 100 K increases the copper resistance by 39 %. Switches and
  /// shunt add 4 %.
  static constexpr float tolerated_increase_if_unmeasured = 0.43f;
  /// The voltage range of a current loop includes this part of the resistance tolerance. A larger resistance reduces
  /// the current at the force limit.
  static constexpr float room_part = 0.25f;
  /// Relative increase of the copper resistance at a rise of 100 K. Heat 1 corresponds to a rise of 100 K.
  static constexpr float part_per_heat = 0.39f;

  float value_ohm;
  float tolerated_increase;  ///< part of value_ohm

  constexpr float with_room_ohm() const { return value_ohm + room_part * tolerated_increase * value_ohm; }

  /// `warmer` is the heat gained since the measurement.
  static constexpr Resistance of(float measured_ohm, float warmer, float parameter_ohm) {
    if (!(measured_ohm > 0.0f)) return {parameter_ohm, tolerated_increase_if_unmeasured};
    // If the motor has cooled since the measurement, the measured resistance is used.
    const float more = warmer > 0.0f ? part_per_heat * warmer : 0.0f;
    return {measured_ohm + measured_ohm * more, tolerated_increase_if_measured};
  }
};

struct MotorCheck {
  /// Tolerance for brushes, diodes and sensor errors, in addition to the bridge drop. The flux tolerance covers short
  /// effects, such as the inductive voltage of a current change.
  static constexpr float tolerance_V = 0.3f;
  /// Above this current, the ripple does not change the sign of the current. Above this current, the bridge drop is
  /// constant.
  static constexpr float steady_A = 0.3f;
  /// A temperature fall of 100 K lowers the resistance by 28 %.
  static constexpr float tolerated_decrease_of_resistance = 0.28f;
  /// A rise of 100 K weakens the magnets by 20 %.
  static constexpr float tolerated_part_of_back_emf = 0.25f;
  /// A current reversal in 0.24 mH needs 1.2 mVs.
  static constexpr float tolerance_flux_Vs = 0.003f;

  /// Each period checks one motor, so each reading represents three periods.
  static constexpr float tolerance_sum_V = tolerance_flux_Vs / (3.0f * protocol::servo_period_s);

  Triple beyond_V{};       ///< sum of the voltages beyond the tolerance, per motor; 0 while its bridge is off
  std::size_t motor = 0;   ///< motor of this period, 0..2
  float voltage_V = 0.0f;  ///< bridge voltage in the period before the present reading
  BridgeLoss loss{};       ///< voltage drop of the bridge in that period

  /// Checks the motor of this period. Returns true if voltage, current and speed of the motor are consistent.
  bool update(const Triple& current_A, const Triple& joint_speed_rad_per_s,
              const std::array<Resistance, 3>& resistances, const Triple& back_emf_Vs_per_rad);

  /// Completes the period. The next call of update() checks `next_motor`, 0..2. `bridge_V` is the bridge voltage of
  /// this motor until the next call, and `bridge_loss` is the voltage drop of the bridge.
  void turn_to(std::size_t next_motor, float bridge_V, const BridgeLoss& bridge_loss) {
    motor = next_motor;
    voltage_V = bridge_V;
    loss = bridge_loss;
  }

  /// Clears the sums. Call this function while the current loops do not drive the bridges.
  void reset() {
    beyond_V = {};
    voltage_V = 0.0f;
  }
};

/// Unexplained voltage and its tolerance.
struct Unexplained {
  float voltage_V, tolerance_V;
};
inline Unexplained unexplained(float voltage_V, const BridgeLoss& loss, float current_A, float joint_speed_rad_per_s,
                               const Resistance& resistance, float back_emf_Vs_per_rad) {
  const float ohmic_V = resistance.value_ohm * current_A;
  const float back_emf_V = back_emf_Vs_per_rad * joint_speed_rad_per_s;
  const float left_V = voltage_V - ohmic_V - back_emf_V;
  const bool is_more = left_V * current_A > 0.0f;
  const float part_of_resistance =
      is_more ? resistance.tolerated_increase : MotorCheck::tolerated_decrease_of_resistance;
  // The bridge drop reduces the tolerance for voltages that are too small.
  const float bridge_V = is_more || !(std::fabs(current_A) > MotorCheck::steady_A) ? loss.most_V : -loss.least_V();
  return {std::fabs(left_V), bridge_V + MotorCheck::tolerance_V + part_of_resistance * std::fabs(ohmic_V) +
                                 MotorCheck::tolerated_part_of_back_emf * std::fabs(back_emf_V)};
}

/// Returns the voltage range of a motor for currents up to +-`most_A`. The range is limited to +-`bound_V`.
/// `back_emf_V` is the approximate back EMF of the motor. The range always contains 0 V, so that a wrong speed value
/// cannot drive the motor.
inline VoltageRange voltage_range(float most_A, const Resistance& resistance, float back_emf_V, float bridge_V,
                                  float bound_V) {
  const float half_V =
      resistance.with_room_ohm() * most_A + bridge_V + MotorCheck::tolerated_part_of_back_emf * std::fabs(back_emf_V);
  return {std::max(std::min(back_emf_V - half_V, 0.0f), -bound_V),
          std::min(std::max(back_emf_V + half_V, 0.0f), bound_V)};
}

}  // namespace inkwell::control
