// Whether a motor's voltage, current and speed fit together.
//
// A motor takes the voltage R i + k w: its resistance times its current, and its back EMF. The voltage is the one that
// its bridge was told, the current comes from the shunt, the speed from the encoder. A current reading that stands
// still, is another motor's or is too small makes the current loop drive the motor with a voltage that the reading does
// not explain; so does a motor that is open, or a leg of its bridge that does not follow. The force is then any. A
// voltage that is too small for its current tells of a motor with shorted turns, or of a reading that is too large.
//
// Both sides are compared as long as the bridges drive by their current loops. What they differ by beyond what a sound
// motor may is summed over time, to a flux: an inductance that is left out of the equation adds no more than its own
// L di to it, and a large difference is noticed sooner than a small one.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <control/vector.hpp>
#include <protocol/reports.hpp>

namespace inkwell::control {

/// What a sound motor's voltage goes into.
struct MotorModel {
  Triple resistance_ohm;  ///< as the parameters say
  /// Of the joint's speed: gear ratio times torque constant, negative for a reversed motor.
  Triple back_emf_Vs_per_rad;
};

/// What a bridge takes from its motor's voltage, always against the current. With little or no current it may give as
/// much.
struct BridgeLoss {
  float measured_V;  ///< by the self-test, brushes included; 0 where it could not tell
  float most_V;      ///< by its dead time

  constexpr float least_V() const { return measured_V < most_V ? measured_V : most_V; }
  constexpr float expected_V() const { return measured_V > 0.0f ? measured_V : most_V; }
};

/// What the self-test has measured of motors and bridges, each by the last test that could tell.
struct MeasuredMotors {
  Triple bridge_loss_part{};  ///< of the supply: what a bridge takes, and brushes with it; 0 if unknown
  Triple resistance_ohm{};    ///< 0 if unknown
  Triple heat{};              ///< at which the resistance was measured (MotorHeat)
};

/// What a motor's resistance is taken for.
struct Resistance {
  /// How much more a motor may have that was measured: a model that is 50 K wrong about the heat since then is borne.
  static constexpr float bearable_more_if_measured = 0.2f;
  /// One of which only the parameters tell. Copper that is 100 K hotter has 39 % more; switches and shunt add 4 %.
  static constexpr float bearable_more_else = 0.43f;
  /// A current loop's voltage has room for so much of that: 5 % of a motor that was measured. A sound one may well have
  /// more, by its angle or its heat: it then gets less current at the force limit, and no fault.
  static constexpr float room_part = 0.25f;
  /// What the rise that the continuous current leads to, 100 K, adds to copper's.
  static constexpr float part_per_heat = 0.39f;

  float value_ohm;
  float bearable_more;  ///< part of it

  constexpr float with_room_ohm() const { return value_ohm + room_part * bearable_more * value_ohm; }

  /// `warmer` is the heat that was gained since it was measured.
  static constexpr Resistance of(float measured_ohm, float warmer, float parameter_ohm) {
    if (!(measured_ohm > 0.0f)) return {parameter_ohm, bearable_more_else};
    // A motor that has cooled down since was hot, or was only taken for hot as its heat was kept over a restart.
    const float more = warmer > 0.0f ? part_per_heat * warmer : 0.0f;
    return {measured_ohm + measured_ohm * more, bearable_more_if_measured};
  }
};

struct MotorWatch {
  /// For brushes, diodes and sensors that err, beside what the bridge takes. What ends by itself only adds to the sum:
  /// the voltage that a change of current takes, and the speed of an arm that is being stopped, which is known a
  /// millisecond late.
  static constexpr float bearable_V = 0.3f;
  /// From here on a current keeps its sign all through the PWM's period, ripple and all, so that its bridge takes what
  /// it takes from any.
  static constexpr float steady_A = 0.3f;
  /// A motor has 28 % less resistance if it was measured 100 K hotter.
  static constexpr float bearable_less_resistance = 0.28f;
  /// Its magnets have then 20 % less.
  static constexpr float bearable_part_of_back_emf = 0.25f;
  /// A motor of 0.24 mH takes 1.2 mVs to turn its current round from one limit to the other.
  static constexpr float bearable_flux_Vs = 0.003f;

  /// The motors take turns, so a reading stands for three periods.
  static constexpr float bearable_sum_V = bearable_flux_Vs / (3.0f * protocol::servo_period_s);

  Triple beyond_V{};       ///< of each motor, the sum of what was beyond the bearable; 0 while its bridge is off
  std::size_t motor = 0;   ///< whose turn it is, 0..2
  float voltage_V = 0.0f;  ///< that its bridge had in the period that the present reading ends
  BridgeLoss loss{};       ///< what the bridge took from it
};

/// What the model leaves unexplained of a motor's voltage, and how much a sound motor may leave.
struct Unexplained {
  float voltage_V, bearable_V;
};
inline Unexplained unexplained(float voltage_V, const BridgeLoss& loss, float current_A, float joint_speed_rad_per_s,
                               const Resistance& resistance, float back_emf_Vs_per_rad) {
  const float ohmic_V = resistance.value_ohm * current_A;
  const float back_emf_V = back_emf_Vs_per_rad * joint_speed_rad_per_s;
  const float left_V = voltage_V - ohmic_V - back_emf_V;
  const bool is_more = left_V * current_A > 0.0f;
  const float part_of_resistance = is_more ? resistance.bearable_more : MotorWatch::bearable_less_resistance;
  // A bridge only takes: a voltage that is too small for its current lacks that as well.
  const float bridge_V = is_more || !(std::fabs(current_A) > MotorWatch::steady_A) ? loss.most_V : -loss.least_V();
  return {std::fabs(left_V), bridge_V + MotorWatch::bearable_V + part_of_resistance * std::fabs(ohmic_V) +
                                 MotorWatch::bearable_part_of_back_emf * std::fabs(back_emf_V)};
}

/// One control period: whether the motor whose turn it is still fits. Speed, resistance and back EMF (MotorModel)
/// belong to it as well.
bool fits(MotorWatch& watch, const Triple& current_A, const Triple& joint_speed_rad_per_s,
          const std::array<Resistance, 3>& resistances, const Triple& back_emf_Vs_per_rad);

/// While the bridges do not drive by their loops: what was is forgotten.
inline void rest(MotorWatch& watch) {
  watch.beyond_V = {};
  watch.voltage_V = 0.0f;
}

/// Ends the period: `motor`, 0..2, is next, and `voltage_V` is what its bridge is to have until then, of which it takes
/// `loss`.
inline void turn_to(MotorWatch& watch, std::size_t motor, float voltage_V, const BridgeLoss& loss) {
  watch.motor = motor;
  watch.voltage_V = voltage_V;
  watch.loss = loss;
}

}  // namespace inkwell::control
