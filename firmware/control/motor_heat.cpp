#include <control/motor_heat.hpp>

namespace inkwell::control {

void update_heat(MotorHeat& motors, const Triple& current_A, const HeatScale& scale) {
  for (std::size_t i = 0; i < 3; ++i) motors.square_sum_A2[i] += current_A[i] * current_A[i];
  if (++motors.periods < MotorHeat::periods_per_update) return;
  for (std::size_t i = 0; i < 3; ++i)
    motors.heat[i] += scale.weight * (motors.square_sum_A2[i] * scale.per_square_sum[i] - motors.heat[i]);
  motors.square_sum_A2 = {};
  motors.periods = 0;
}

}  // namespace inkwell::control
