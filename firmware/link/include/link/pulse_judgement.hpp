// What the pulses of the self-test say about motors, bridges and shunts.
#pragma once

#include <array>

#include <control/self_test_pulses.hpp>
#include <control/settings.hpp>
#include <protocol/self_test.hpp>

namespace inkwell::link {

struct PulseJudgement {
  /// Of the resistance that is expected. A winding that is 100 K hotter than where it was measured has 39 % more, one
  /// at the freezing point 10 % less; switches and shunt add 4 %, sensors err by 3 %, the motor's own motion by 5 %.
  /// Half the turns, or a shunt amplifier with twice its gain, are below at any heat, and half its gain is above.
  static constexpr float resistance_minimum_part = 0.78f, resistance_maximum_part = 1.7f;
  /// What is told of a motor through which no current goes, or one of the wrong sign.
  static constexpr float resistance_shown_part = 10.0f;
  /// A bridge may take this many times what its dead time takes.
  static constexpr float dead_time_ratio = 1.8f;
  /// Current in another motor's sensor, as a part of the motor's own. Two wires that touch share it evenly.
  static constexpr float foreign_part = 0.25f;
  /// A mean back EMF from which on it need not be steady, and a resistance that is out of its bounds is no failure yet.
  static constexpr float moves_V = 0.15f;
  /// What is kept of a resistance has to be better than what passes: both signs agree within so many parts, and the
  /// mean back EMF is less. A motor that its own pulses make quicker, as one of an arm that nobody holds, seems to have
  /// 5 % more.
  static constexpr float kept_apart = 1.06f, rests_V = 0.08f;

  using Result = protocol::SelfTestResult;
  struct Found {
    Result result = Result::not_done;
    float figure = 0.0f;
  };
  std::array<Found, 3> motors;       ///< ohm: the sign with the larger error
  std::array<Found, 3> bridges;      ///< V that the bridge takes
  Found wires;                       ///< A, the largest in a sensor that should see none
  control::Triple bridge_loss_part;  ///< of the supply: what a bridge that passes takes; 0 if it seems to give
  control::Triple resistance_ohm;    ///< of a motor that passes and rests: the mean of both signs; else 0

  bool any(Result result) const;
  /// Of an arm that moved too fast for pulses.
  static PulseJudgement moved();
};

PulseJudgement judge(const control::PulseRound& round, const control::Settings& settings);

}  // namespace inkwell::link
