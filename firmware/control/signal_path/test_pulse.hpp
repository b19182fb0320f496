// Motor pulses of the commands test_current and test_voltage.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/conditioning.hpp"
#include "firmware/control/signal_path/kinematics.hpp"
#include "firmware/control/signal_path/trigonometry.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Pulse with the height `amplitude` and the duration `pulse_periods`. After each pulse, a rest of the same duration
/// lets the current decay.
struct TestPulse {
  enum class Quantity : std::uint8_t { current, voltage };

  Quantity quantity = Quantity::current;
  std::uint8_t motor = 0;               ///< index 0..2
  float amplitude = 0.0f;               ///< A or V
  std::uint32_t pulse_periods = 0;      ///< length of the pulse and of the following rest
  std::uint32_t remaining_periods = 0;  ///< remaining time of pulse and rest; 0 when no test runs
  float moved_J = 0.0f;                 ///< energy exchanged between motor and arm so far, as a magnitude

  bool runs() const { return remaining_periods > 0; }
  void end() { remaining_periods = 0; }
  /// Stops the pulse. The rest after the pulse is not skipped.
  void end_pulse() { remaining_periods = remaining_periods < pulse_periods ? remaining_periods : pulse_periods; }
  /// Current or voltage of the motor in this period.
  float value() const { return remaining_periods > pulse_periods ? amplitude : 0.0f; }
};

/// Returns the pulse of a command. The pulse is empty if the motor does not exist or the time is not positive.
constexpr TestPulse start_test_pulse(const protocol::TestPulse& wanted, TestPulse::Quantity quantity) {
  if (wanted.motor < 1 || wanted.motor > 3 || !(wanted.duration_s > 0.0f)) return {};
  const float duration_s =
      wanted.duration_s < protocol::test_duration_maximum_s ? wanted.duration_s : protocol::test_duration_maximum_s;
  const std::uint32_t periods = periods_in(duration_s);
  return {quantity, static_cast<std::uint8_t>(wanted.motor - 1), wanted.amplitude, periods, 2 * periods};
}

/// Returns the current of one motor for a force of `force_limit_N` on the hand. The hand is assumed to fix the probe.
/// The force of one motor is perpendicular to the probe motions of the other two joints. Returns 0 if the force
/// direction is undefined in this pose.
inline float test_limit_A(const Jacobian& jacobian, std::size_t motor, float force_limit_N, float ampere_per_Nm) {
  const std::size_t next = motor == 2 ? 0 : motor + 1, last = motor == 0 ? 2 : motor - 1;
  const Vector3 across = cross(jacobian.column[next], jacobian.column[last]);
  const float squared = dot(across, across);
  if (!(squared > 0.0f)) return 0.0f;
  const float lever_m = dot(jacobian.column[motor], across) * reciprocal_square_root(squared);
  return std::fabs(force_limit_N * lever_m * ampere_per_Nm);
}

}  // namespace inkwell::control
