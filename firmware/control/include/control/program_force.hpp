// The force that a program on the PC asks for: a report each few milliseconds becomes a line, not a staircase.
#pragma once

#include <cstdint>

#include <control/vector.hpp>
#include <protocol/reports.hpp>

namespace inkwell::control {

/// One report of the program, checked and prepared outside of the interrupt.
struct ForceTarget {
  Vector3 force_N;  ///< on the hand, workspace axes; finite
  protocol::ForceMode mode = protocol::ForceMode::none;
  std::uint32_t interval_periods = 1;  ///< from one report of the program to the next
  float per_interval = 1.0f;           ///< 1 / interval_periods
};

struct ProgramForceLimits {
  float force_limit_N;           ///< bound of a report's magnitude
  float change_N_per_period;     ///< bound of how fast the force changes, as a vector
  float periods_per_N;           ///< 1 / change_N_per_period
  std::uint32_t expiry_periods;  ///< silence after which the force fades
};

/// What is felt of a program: moves towards the newest report and fades when no other comes.
struct ProgramForce {
  /// From the expiry of the last report to no force: 10 ms.
  static constexpr std::uint32_t fade_periods = protocol::servo_rate_Hz / 100;

  Vector3 force_N;
  Vector3 target_N;               ///< of the newest report
  Vector3 step_N;                 ///< a period, while `steps` is not 0
  std::uint32_t steps = 0;        ///< still to go to the newest report
  Vector3 fading_N;               ///< what there was when the fading began
  std::uint32_t fade_steps = 0;   ///< still to go to nothing
  std::uint32_t age_periods = 0;  ///< since the newest report
  std::uint32_t interval_periods = 1;
  protocol::ForceMode mode = protocol::ForceMode::none;

  bool is_driven() const { return mode != protocol::ForceMode::none; }
};

/// Heads for a new report: a line to it in the program's interval, or for longer if the force would change too fast.
/// A report that is too large keeps its direction. Returns whether the report came more than a millisecond late.
[[gnu::cold]] bool head_for(ProgramForce& program, const ForceTarget& target, const ProgramForceLimits& limits);

/// One control period further. When the reports stay away the force fades and the program no longer drives.
void advance(ProgramForce& program, const ProgramForceLimits& limits);

}  // namespace inkwell::control
