// Small voltage pulses for the self-test of motors, bridges and shunts. The pulses drive one motor after another. Each
// motor is driven with the levels low, high, -high and -low, followed by a rest.
//
// The currents at the low and the high level determine the resistance. The dead time of the bridge and a constant back
// EMF reduce both currents equally. The force impulses on the hand add up to zero.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/conditioning.hpp"
#include "firmware/control/signal_path/vector.hpp"
#include "firmware/control/supervision/motor_check.hpp"

namespace inkwell::control {

/// Measurements during the pulses. The main loop evaluates these measurements.
struct PulseRound {
  static constexpr std::size_t levels = 4;  ///< low, high, -high, -low
  struct Motor {
    std::array<Triple, levels> current_A{};  ///< mean of each of the three sensors at each level
    float low_V = 0.0f, high_V = 0.0f;
    std::int32_t moved_counts = 0;  ///< motion of the motor's encoder during the four levels
    float levels_s = 0.0f;          ///< duration of the four levels
    bool takes_part = false;
  };
  std::array<Motor, 3> motors{};
  float supply_V = 0.0f;
  float dead_V = 0.0f;  ///< voltage drop from the dead time of the bridges
};

/// Assumed resistance of each motor, and duration of a level.
struct PulseSize {
  Triple resistance_ohm{};
  std::array<std::uint32_t, 3> level_periods{};

  /// A smaller resistance increases the electrical time constant. Only the main loop calls this function, because its
  /// divisions are slow (settings.cpp).
  static PulseSize of(const Triple& resistance_ohm);
};

/// These values also determine the pulse voltages.
struct PulseScale {
  const Triple& current_limit_A;  ///< a motor with limit 0 is not used
  float supply_V;
  float dead_time_part;  ///< voltage drop from the dead time of the bridges, as a part of the supply
};

class SelfTestPulses {
 public:
  /// Shortest duration of a level: nine electrical time constants of an Omni motor.
  static constexpr std::uint32_t level_periods = periods_in(0.001f);
  /// Longest duration of a level: six electrical time constants of an Omni winding with 0.5 ohm.
  static constexpr std::uint32_t level_maximum_periods = 3 * level_periods;
  /// Only the last periods of a level are averaged, after the current has settled.
  static constexpr std::uint32_t mean_periods = 8;
  static constexpr std::uint32_t rest_periods = 10;
  static constexpr std::uint32_t round_periods = 3 * (PulseRound::levels * level_periods + rest_periods);
  /// Expected current at the high level. This current causes a force of 1.4 N for 1 ms. The current at the low level is
  /// `low_part` of this current.
  static constexpr float high_A = 0.7f, low_part = 0.4f;
  /// Smallest pulse current of all motors. The resistance cannot be measured with a smaller current. Every motor
  /// tolerates this current for 1 ms.
  static constexpr float high_minimum_A = 0.3f;
  /// Over-current bound during the pulses.
  static constexpr float maximum_A = 1.5f * high_A;
  /// Voltage bound for windings with a high resistance.
  static constexpr float ohmic_maximum_V = 7.5f;

  /// Starts a round with pulses of this size.
  void start(const PulseSize& size) {
    size_ = size;
    runs_ = true;
    motor_ = level_ = 0;
    periods_ = 0;
  }
  void stop() { runs_ = false; }
  bool runs() const { return runs_; }

  /// Runs one control period of the test pulses. Returns the voltage of each motor for the next period.
  [[gnu::cold]] Triple step(const Triple& current_A, const std::array<std::int32_t, 3>& encoder_counts,
                            const PulseScale& scale);

  /// The measurements are complete after the round has finished.
  const PulseRound& round() const { return round_; }

 private:
  [[gnu::cold]] void size_pulses(const PulseScale& scale);

  PulseRound round_;
  PulseSize size_;
  std::size_t motor_ = 0;
  std::size_t level_ = 0;      ///< `levels` while the motor rests
  std::uint32_t periods_ = 0;  ///< number of periods of this level
  bool runs_ = false;
};

}  // namespace inkwell::control
