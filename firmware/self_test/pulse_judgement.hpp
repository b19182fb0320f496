// Evaluates the self-test pulses for motors, bridges and shunts.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/control/settings.hpp"
#include "firmware/control/supervision/self_test_pulses.hpp"
#include "protocol/self_test.hpp"

namespace inkwell::link {

struct PulseJudgement {
  /// Limits relative to the expected resistance. The winding resistance changes by +39 % at +100 K, and by -10 % at 0
  /// C. Switches and shunt add 4 %. Sensor errors contribute 3 %, and motor motion contributes 5 %.
  ///
  /// Half the winding turns or twice the amplifier gain lowers the measured resistance below the lower limit at any
  /// temperature. Half the amplifier gain raises the measured resistance above the upper limit.
  static constexpr float resistance_minimum_part = 0.78f, resistance_maximum_part = 1.7f;
  /// Largest reported resistance, relative to the expected resistance. This value means no current or a current of the
  /// wrong sign.
  static constexpr float resistance_shown_part = 10.0f;
  /// Resistances of the motors that a user may confirm. The bounds of the result have a margin for the error of the
  /// self-test.
  static constexpr float smallest_ohm = 0.5f, largest_ohm = 30.0f;
  static constexpr float unknown_minimum_ohm = 0.9f * smallest_ohm, unknown_maximum_ohm = 1.1f * largest_ohm;
  /// Above this resistance, a motor is missing. The current at the largest pulse voltage is then 75 mA.
  static constexpr float missing_ohm = 100.0f;
  /// Largest voltage loss of a bridge, relative to the loss from its dead time.
  static constexpr float dead_time_ratio = 1.8f;
  /// Largest current in the sensor of an idle motor, relative to the current of the pulsed motor. Two touching wires
  /// share the current evenly.
  static constexpr float foreign_part = 0.25f;
  /// A higher mean back EMF indicates a moving arm, for which a wrong resistance is not a failure.
  static constexpr float moves_V = 0.15f;
  /// The same for a motor that is not confirmed, because its torque constant is not known: the largest motion of its
  /// encoder during the pulses. The pulses of an Omni motor move its encoder by two counts.
  static constexpr std::int32_t rests_counts = 5;
  /// Stricter limits for a stored resistance. The resistances for both current signs may differ by the factor
  /// `kept_apart`. The mean back EMF must be below `rests_V`. On a freely moving arm, the measured resistance is 5 %
  /// too high.
  static constexpr float kept_apart = 1.06f, rests_V = 0.08f;

  using Result = protocol::SelfTestResult;
  struct Found {
    Result result = Result::not_done;
    float figure = 0.0f;
  };
  std::array<Found, 3> motors;   ///< resistance in ohm, for the current sign with the larger error
  std::array<Found, 3> bridges;  ///< voltage loss of the bridge in V
  Found wires;                   ///< largest current in the sensor of another motor, in A
  /// Voltage loss of a healthy bridge, relative to the supply voltage. The value is 0 if the measured loss is negative.
  control::Triple bridge_loss_part;
  /// Mean resistance for both current signs. The value is 0 for a moving motor or after a failure.
  control::Triple resistance_ohm;
  /// Rough resistance for the size of the next pulses, 0.5 to 30 ohm.
  control::Triple estimate_ohm;

  bool any(Result result) const;
  /// Returns the result for a moving arm.
  static PulseJudgement moved();
};

PulseJudgement judge(const control::PulseRound& round, const control::Settings& settings);

}  // namespace inkwell::link
