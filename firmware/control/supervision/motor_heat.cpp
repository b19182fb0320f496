#include "firmware/control/supervision/motor_heat.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

namespace {

void warm(MotorHeat& motors, std::size_t motor, const HeatScale& scale) {
  const float lasting = motors.square_sum_A2[motor] * scale.per_square_sum[motor];
  const float lasting_winding = scale.winding_part * lasting;
  motors.square_sum_A2[motor] = 0.0f;
  float& housing = motors.housing[motor];
  const float winding = motors.heat[motor] - housing;
  housing += scale.housing_per_update * (lasting - lasting_winding - housing);
  motors.heat[motor] = housing + winding + scale.winding_per_update * (lasting_winding - winding);
}

void hold_back(MotorHeat& motors, std::size_t motor) {
  const float beyond = motors.heat[motor] - protocol::motor_heat_limits_from;
  motors.beyond[motor] = beyond > 0.0f ? beyond : 0.0f;
}

void judge(MotorHeat& motors) {
  const float bound = motors.too_hot ? protocol::motor_heat_limits_from : protocol::motor_heat_fault;
  motors.too_hot = motors.heat[0] > bound || motors.heat[1] > bound || motors.heat[2] > bound;
}

}  // namespace

void update_heat(MotorHeat& motors, std::size_t motor, float current_A, const HeatScale& scale) {
  motors.square_sum_A2[motor] += current_A * current_A;
  // Each period runs only one task, so that the longest control interrupt stays short.
  switch (motors.readings) {
    case 0: hold_back(motors, motor); break;
    case 1:
      if (motor == 0) judge(motors);
      break;
    case MotorHeat::readings_per_update - 1: warm(motors, motor, scale); break;
    default: break;
  }
  if (motor == 2) motors.readings = (motors.readings + 1) % MotorHeat::readings_per_update;
}

}  // namespace inkwell::control
