// Evaluates the self-test pulses for motors, bridges and shunts.
#pragma once

#include <array>

#include "firmware/control/settings.hpp"
#include "firmware/control/supervision/self_test_pulses.hpp"
#include "protocol/self_test.hpp"

namespace inkwell::link {

struct PulseJudgement {
  /// Limits relative to the expected resistance. The resistance of a winding is 39 % higher at +100 K, and 10 % lower
  /// at the freezing point. Switches and shunt add 4 %. The sensor error is 3 %, and the motion of the motor
  /// contributes 5 %.
  ///
  /// With half the winding turns, or with twice the amplifier gain, the measured resistance is below these limits at
  /// any temperature. With half the amplifier gain, the measured resistance is above these limits.
  static constexpr float resistance_minimum_part = 0.78f, resistance_maximum_part = 1.7f;
  /// Largest reported resistance, relative to the expected resistance. This value is reported for a motor without
  /// current or with a current of the wrong sign.
  static constexpr float resistance_shown_part = 10.0f;
  /// Largest voltage loss of a bridge, relative to the loss from its dead time.
  static constexpr float dead_time_ratio = 1.8f;
  /// Largest current in the sensor of an idle motor, relative to the current of the pulsed motor. Two touching wires
  /// share the current evenly.
  static constexpr float foreign_part = 0.25f;
  /// Above this mean back EMF the arm moves, so a resistance outside its limits does not count as a failure.
  static constexpr float moves_V = 0.15f;
  /// Stricter limits for a stored resistance. The resistances for both current signs must agree within the factor
  /// `kept_apart`, and the mean back EMF must be below `rests_V`. If no hand fixes the arm, the pulses accelerate the
  /// motor, and the measured resistance is 5 % too high.
  static constexpr float kept_apart = 1.06f, rests_V = 0.08f;

  using Result = protocol::SelfTestResult;
  struct Found {
    Result result = Result::not_done;
    float figure = 0.0f;
  };
  std::array<Found, 3> motors;   ///< resistance in ohm, for the current sign with the larger error
  std::array<Found, 3> bridges;  ///< voltage loss of the bridge in V
  Found wires;                   ///< largest current in the sensor of another motor, in A
  /// Voltage loss of a bridge without a failure, relative to the supply voltage. The value is 0 if the measured loss is
  /// negative.
  control::Triple bridge_loss_part;
  /// Mean resistance for both current signs, if the motor passes the test and is at rest. Otherwise the value is 0.
  control::Triple resistance_ohm;

  bool any(Result result) const;
  /// Returns the result for an arm that moved too fast for pulses.
  static PulseJudgement moved();
};

PulseJudgement judge(const control::PulseRound& round, const control::Settings& settings);

}  // namespace inkwell::link
