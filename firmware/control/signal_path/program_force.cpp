#include "firmware/control/signal_path/program_force.hpp"

#include "firmware/control/signal_path/contact.hpp"
#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

using protocol::ForceMode;

constexpr std::uint32_t millisecond_periods = protocol::servo_rate_Hz / 1000;
constexpr float per_fade = 1.0f / static_cast<float>(ProgramForce::fade_periods);

void fade(ProgramForce& program) {
  program.mode = ForceMode::none;
  program.steps = 0;
  program.fading_N = program.force_N;
  program.fade_steps = ProgramForce::fade_periods;
}

}  // namespace

bool set_target(ProgramForce& program, const ForceTarget& target, const ProgramForceLimits& limits) {
  const bool late = program.is_driven() && program.age_periods > program.interval_periods + millisecond_periods;
  program.age_periods = 0;
  program.interval_periods = target.interval_periods;
  if (target.mode == ForceMode::none) {
    if (program.is_driven()) fade(program);
    return late;
  }
  program.mode = target.mode;
  program.fade_steps = 0;
  program.target_N = bounded(target.force_N, limits.force_limit_N).force_N;
  const Vector3 way_N = program.target_N - program.force_N;
  program.steps = target.interval_periods;
  program.step_N = target.per_interval * way_N;
  const Force step = bounded(program.step_N, limits.change_N_per_period);
  if (step.magnitude_N < limits.change_N_per_period) return late;
  // The rate limit extends the transition. The last step reaches the target exactly.
  program.step_N = step.force_N;
  program.steps =
      1 + static_cast<std::uint32_t>(bounded(way_N, 2.0f * limits.force_limit_N).magnitude_N * limits.periods_per_N);
  return late;
}

void advance(ProgramForce& program, const ProgramForceLimits& limits) {
  if (program.fade_steps != 0) {
    --program.fade_steps;
    program.force_N = (per_fade * static_cast<float>(program.fade_steps)) * program.fading_N;
    return;
  }
  if (!program.is_driven()) return;
  if (program.steps != 0) {
    --program.steps;
    program.force_N = program.steps == 0 ? program.target_N : program.force_N + program.step_N;
  }
  if (++program.age_periods >= limits.expiry_periods) fade(program);
}

}  // namespace inkwell::control
