#include "firmware/control/supervision/self_test_pulses.hpp"

#include <algorithm>

namespace inkwell::control {

void SelfTestPulses::size_pulses(const PulseScale& scale) {
  const float resistance_ohm = size_.resistance_ohm[motor_];
  const float limit_A = scale.current_limit_A[motor_];
  const float ohmic_V = std::min(resistance_ohm * std::clamp(limit_A, high_minimum_A, high_A), ohmic_maximum_V);
  round_.supply_V = scale.supply_V;
  round_.dead_V = scale.dead_time_part * scale.supply_V;
  PulseRound::Motor& motor = round_.motors[motor_];
  motor.takes_part = limit_A > 0.0f;
  motor.levels_s = static_cast<float>(PulseRound::levels * size_.level_periods[motor_]) * protocol::servo_period_s;
  motor.low_V = round_.dead_V + low_part * ohmic_V;
  motor.high_V = round_.dead_V + ohmic_V;
}

Triple SelfTestPulses::step(const Triple& current_A, const std::array<std::int32_t, 3>& encoder_counts,
                            const PulseScale& scale) {
  constexpr float per_reading = 1.0f / static_cast<float>(mean_periods);
  PulseRound::Motor& motor = round_.motors[motor_];
  const std::uint32_t motor_level_periods = size_.level_periods[motor_];
  if (level_ == 0 && periods_ == 0) {
    size_pulses(scale);
    motor.moved_counts = -encoder_counts[motor_];
  }
  Triple voltage_V{};
  const bool rests = level_ == PulseRound::levels;
  if (!rests && motor.takes_part) {
    const float size_V = level_ == 0 || level_ == 3 ? motor.low_V : motor.high_V;
    voltage_V[motor_] = level_ < 2 ? size_V : -size_V;
    Triple& mean_A = motor.current_A[level_];
    if (periods_ == motor_level_periods - mean_periods) mean_A = {};
    if (periods_ >= motor_level_periods - mean_periods)
      for (std::size_t i = 0; i < 3; ++i) mean_A[i] += current_A[i] * per_reading;
  }
  if (++periods_ < (rests ? rest_periods : motor_level_periods)) return voltage_V;
  periods_ = 0;
  if (!rests && ++level_ < PulseRound::levels) return voltage_V;
  if (!rests) {
    motor.moved_counts += encoder_counts[motor_];
    return voltage_V;
  }
  level_ = 0;
  runs_ = ++motor_ < 3;
  return voltage_V;
}

}  // namespace inkwell::control
