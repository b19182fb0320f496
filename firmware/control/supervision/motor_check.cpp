#include "firmware/control/supervision/motor_check.hpp"

namespace inkwell::control {

bool update_motor_check(MotorCheck& check, const Triple& current_A, const Triple& joint_speed_rad_per_s,
                        const std::array<Resistance, 3>& resistances, const Triple& back_emf_Vs_per_rad) {
  const std::size_t motor = check.motor;
  const Unexplained deviation = unexplained(check.voltage_V, check.loss, current_A[motor], joint_speed_rad_per_s[motor],
                                            resistances[motor], back_emf_Vs_per_rad[motor]);
  const float beyond_V = check.beyond_V[motor] + deviation.voltage_V - deviation.tolerance_V;
  check.beyond_V[motor] = 0.0f;
  if (!(beyond_V > 0.0f)) [[likely]]
    return true;
  check.beyond_V[motor] = beyond_V;
  return beyond_V <= MotorCheck::tolerance_sum_V;
}

}  // namespace inkwell::control
