// Force of a program on the PC. The force is interpolated linearly between the program's reports.
#pragma once

#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Validated force report of a program.
struct ForceTarget {
  Vector3 force_N;  ///< on the hand, workspace axes; finite
  protocol::ForceMode mode = protocol::ForceMode::none;
  std::uint32_t interval_periods = 1;  ///< time between two reports of the program
  float per_interval = 1.0f;           ///< 1 / interval_periods
};

struct ProgramForceLimits {
  float force_limit_N;           ///< bound of a report's magnitude
  float change_N_per_period;     ///< bound of the magnitude of the force change
  float periods_per_N;           ///< 1 / change_N_per_period
  std::uint32_t expiry_periods;  ///< time without a report after which the force fades
};

/// Force of a program. Without a new report, the force fades after `expiry_periods`.
struct ProgramForce {
  /// Duration of the fade to zero: 10 ms.
  static constexpr std::uint32_t fade_periods = protocol::servo_rate_Hz / 100;

  Vector3 force_N;
  Vector3 target_N;               ///< force of the newest report
  Vector3 step_N;                 ///< change per period while `steps` is not 0
  std::uint32_t steps = 0;        ///< remaining steps to the newest report
  Vector3 fading_N;               ///< force at the start of the fade
  std::uint32_t fade_steps = 0;   ///< remaining steps to zero force
  std::uint32_t age_periods = 0;  ///< age of the newest report
  std::uint32_t interval_periods = 1;
  protocol::ForceMode mode = protocol::ForceMode::none;

  /// Starts a linear transition to a new report. The rate limit may extend the transition beyond the program's
  /// interval. A force above the limit is reduced to the limit and keeps its direction. Returns true if the report
  /// arrived more than 1 ms late.
  [[gnu::cold]] bool set_target(const ForceTarget& target, const ProgramForceLimits& limits);

  /// Advances by one control period. Without new reports, the force fades and the program stops being a force source.
  void advance(const ProgramForceLimits& limits);

  bool is_driven() const { return mode != protocol::ForceMode::none; }

 private:
  void fade();
};

}  // namespace inkwell::control
