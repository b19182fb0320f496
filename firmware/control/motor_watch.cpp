#include <control/motor_watch.hpp>

#include <cmath>

namespace inkwell::control {

bool fits(MotorWatch& watch, const Triple& current_A, const Triple& joint_speed_rad_per_s, const MotorModel& model) {
  const std::size_t motor = watch.motor;
  const float ohmic_V = model.resistance_ohm[motor] * current_A[motor];
  const float back_emf_V = model.back_emf_Vs_per_rad[motor] * joint_speed_rad_per_s[motor];
  const float bearable_V = MotorWatch::bearable_V + MotorWatch::bearable_part_of_resistance * std::fabs(ohmic_V) +
                           MotorWatch::bearable_part_of_back_emf * std::fabs(back_emf_V);
  const float beyond_V = watch.beyond_V[motor] + std::fabs(watch.voltage_V - ohmic_V - back_emf_V) - bearable_V;
  watch.beyond_V[motor] = beyond_V > 0.0f ? beyond_V : 0.0f;
  return !(beyond_V > MotorWatch::bearable_sum_V);
}

}  // namespace inkwell::control
