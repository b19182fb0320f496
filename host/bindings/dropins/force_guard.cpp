#include "host/bindings/dropins/force_guard.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::dropins {
namespace {

/// Expiry time of a force on the board. After a longer pause, the ramp restarts from zero.
constexpr double pause_s = 0.05;

Vector scaled_to(const Vector& vector, double longest) {
  const double scale = longest / std::max(length(vector), longest);
  return longest <= 0.0 ? Vector{} : Vector{scale * vector[0], scale * vector[1], scale * vector[2]};
}

}  // namespace

double length(const Vector& vector) { return std::hypot(vector[0], vector[1], vector[2]); }

ForceGuard::Answer ForceGuard::drop(ErrorCode why) {
  ramp_N_ = 0.0;
  before_N_ = earlier_N_ = {};
  return {{}, why};
}

ForceGuard::Answer ForceGuard::step(const ForceDemand& demand, const ForceLimits& limits) {
  const double passed_s = std::max(0.0, demand.time_s - time_s_);
  time_s_ = demand.time_s;
  if (passed_s > 0.0) {  // several frames may use the same pose: together they may change the force only as much as one
                         // frame
    earlier_N_ = before_N_;
    since_earlier_s_ = passed_s;
  }
  if (!demand.is_on) return drop(success);
  if (limits.limits_speed && demand.speed_m_per_s > limits.speed_m_per_s) return drop(exceeded_max_velocity);
  const bool is_huge = length(demand.force_N) > limits.maximum_N;
  if (is_huge && !limits.clamps && limits.limits_force) return drop(exceeded_max_force);
  if (passed_s > pause_s) drop(success);
  ramp_N_ = limits.ramps ? std::min(limits.maximum_N, ramp_N_ + limits.ramp_N_per_s * std::min(passed_s, pause_s))
                         : limits.maximum_N;

  Vector force_N = limits.clamps ? scaled_to(demand.force_N, limits.maximum_N) : demand.force_N;
  if (limits.ramps && ramp_N_ < limits.maximum_N) force_N = scaled_to(force_N, ramp_N_);
  if (limits.limits_change) {
    Vector change_N;
    for (std::size_t i = 0; i < 3; ++i) change_N[i] = force_N[i] - earlier_N_[i];
    change_N = scaled_to(change_N, limits.change_N_per_ms * 1e3 * std::clamp(since_earlier_s_, 1e-3, pause_s));
    for (std::size_t i = 0; i < 3; ++i) force_N[i] = earlier_N_[i] + change_N[i];
  }
  before_N_ = force_N;
  return {force_N, success};
}

}  // namespace inkwell::dropins
