#include "firmware/control/supervision/motor_heat.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

void MotorHeat::warm(std::size_t motor, const HeatScale& scale) {
  const float lasting = square_sum_A2[motor] * scale.per_square_sum[motor];
  const float lasting_winding = scale.winding_part * lasting;
  square_sum_A2[motor] = 0.0f;
  float& housing_heat = housing[motor];
  const float winding = heat[motor] - housing_heat;
  housing_heat += scale.housing_per_update * (lasting - lasting_winding - housing_heat);
  heat[motor] = housing_heat + winding + scale.winding_per_update * (lasting_winding - winding);
}

void MotorHeat::hold_back(std::size_t motor) {
  const float more = heat[motor] - protocol::motor_heat_limits_from;
  beyond[motor] = more > 0.0f ? more : 0.0f;
}

void MotorHeat::judge() {
  const float bound = too_hot ? protocol::motor_heat_limits_from : protocol::motor_heat_fault;
  too_hot = heat[0] > bound || heat[1] > bound || heat[2] > bound;
}

void MotorHeat::update(std::size_t motor, float current_A, const HeatScale& scale) {
  square_sum_A2[motor] += current_A * current_A;
  // Each period runs only one task, so that the longest control interrupt stays short.
  switch (readings) {
    case 0: hold_back(motor); break;
    case 1:
      if (motor == 0) judge();
      break;
    case readings_per_update - 1: warm(motor, scale); break;
    default: break;
  }
  if (motor == 2) readings = (readings + 1) % readings_per_update;
}

}  // namespace inkwell::control
