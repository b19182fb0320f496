#include "firmware/control/signal_path/program_force.hpp"

#include "firmware/control/signal_path/contact.hpp"
#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

using protocol::ForceMode;

constexpr std::uint32_t millisecond_periods = protocol::servo_rate_Hz / 1000;
constexpr float per_fade = 1.0f / static_cast<float>(ProgramForce::fade_periods);

}  // namespace

void ProgramForce::fade() {
  mode = ForceMode::none;
  steps = 0;
  fading_N = force_N;
  fade_steps = fade_periods;
}

bool ProgramForce::set_target(const ForceTarget& target, const ProgramForceLimits& limits) {
  const bool late = is_driven() && age_periods > interval_periods + millisecond_periods;
  age_periods = 0;
  interval_periods = target.interval_periods;
  if (target.mode == ForceMode::none) {
    if (is_driven()) fade();
    return late;
  }
  mode = target.mode;
  fade_steps = 0;
  target_N = bounded(target.force_N, limits.force_limit_N).force_N;
  const Vector3 way_N = target_N - force_N;
  steps = target.interval_periods;
  step_N = target.per_interval * way_N;
  const Force step = bounded(step_N, limits.change_N_per_period);
  if (step.magnitude_N < limits.change_N_per_period) return late;
  // The rate limit extends the transition. The last step reaches the target exactly.
  step_N = step.force_N;
  steps =
      1 + static_cast<std::uint32_t>(bounded(way_N, 2.0f * limits.force_limit_N).magnitude_N * limits.periods_per_N);
  return late;
}

void ProgramForce::advance(const ProgramForceLimits& limits) {
  if (fade_steps != 0) {
    --fade_steps;
    force_N = (per_fade * static_cast<float>(fade_steps)) * fading_N;
    return;
  }
  if (!is_driven()) return;
  if (steps != 0) {
    --steps;
    force_N = steps == 0 ? target_N : force_N + step_N;
  }
  if (++age_periods >= limits.expiry_periods) fade();
}

}  // namespace inkwell::control
