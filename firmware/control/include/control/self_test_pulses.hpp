// Small pulses of voltage, one motor after the other, by which the self-test looks at motors, bridges and shunts.
//
//   high    +--+
//   low  +--+  |
//   0  --+     |     +-- rest, next motor
//              |  +--+
//              +--+
//
// From the low level to the high one the current rises by what the resistance asks for: dead time of the bridge and a
// steady back EMF take the same from both. The pushes on the hand add up to none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <control/conditioning.hpp>
#include <control/motor_watch.hpp>
#include <control/vector.hpp>

namespace inkwell::control {

/// What the pulses have found, for the main loop to judge.
struct PulseRound {
  static constexpr std::size_t levels = 4;  ///< low, high, -high, -low
  struct Motor {
    std::array<Triple, levels> current_A{};  ///< mean at each level, of all three sensors
    float low_V = 0.0f, high_V = 0.0f;
    std::int32_t moved_counts = 0;  ///< of its encoder, from the first level to the last
    bool takes_part = false;
  };
  std::array<Motor, 3> motors{};
  float supply_V = 0.0f;
  float dead_V = 0.0f;  ///< what the bridges' dead time takes
};

/// What the pulses are sized by.
struct PulseScale {
  const Triple& resistance_ohm;
  const Triple& current_limit_A;  ///< a motor with 0 takes no part
  float supply_V;
  float dead_time_part;  ///< of the supply: what the bridges' dead time takes from a motor's voltage
};

class SelfTestPulses {
 public:
  /// Nine times the time constant of a motor.
  static constexpr std::uint32_t level_periods = periods_in(0.001f);
  /// The last of them, by when the current has settled, are averaged.
  static constexpr std::uint32_t mean_periods = 8;
  static constexpr std::uint32_t rest_periods = 10;
  static constexpr std::uint32_t round_periods = 3 * (PulseRound::levels * level_periods + rest_periods);
  /// Current at the high level, as far as the motor's resistance explains it: 1.4 N at the hand for a millisecond. The
  /// low level has so large a part of it.
  static constexpr float high_A = 0.7f, low_part = 0.4f;
  /// A motor with a lower current limit gets pulses of this current all the same: less tells no resistance, and every
  /// motor bears it for a millisecond.
  static constexpr float high_minimum_A = 0.3f;
  /// What a motor's back EMF and the other motors' pulses add to it does not count as over-current.
  static constexpr float bearable_A = 1.5f * high_A;
  /// For windings with more resistance than that takes.
  static constexpr float ohmic_maximum_V = 7.5f;

  void start() {
    runs_ = true;
    motor_ = level_ = 0;
    periods_ = 0;
  }
  void stop() { runs_ = false; }
  bool runs() const { return runs_; }

  /// One control period of a round: the voltage of each motor for the next one.
  [[gnu::cold]] Triple step(const Triple& current_A, const std::array<std::int32_t, 3>& encoder_counts,
                            const PulseScale& scale);

  /// Whole once a round that was started runs no more.
  const PulseRound& round() const { return round_; }

 private:
  [[gnu::cold]] void size_pulses(const PulseScale& scale);

  PulseRound round_;
  std::size_t motor_ = 0;
  std::size_t level_ = 0;      ///< `levels` while the motor rests
  std::uint32_t periods_ = 0;  ///< of this level
  bool runs_ = false;
};

}  // namespace inkwell::control
