#include <control/motor_heat.hpp>

namespace inkwell::control {

void update_heat(MotorHeat& motors, std::size_t motor, float current_A, const HeatScale& scale) {
  motors.square_sum_A2[motor] += current_A * current_A;
  if (motor != 2 || ++motors.readings < MotorHeat::readings_per_update) return;
  for (std::size_t i = 0; i < 3; ++i)
    motors.heat[i] += scale.weight * (motors.square_sum_A2[i] * scale.per_square_sum[i] - motors.heat[i]);
  motors.square_sum_A2 = {};
  motors.readings = 0;
}

}  // namespace inkwell::control
