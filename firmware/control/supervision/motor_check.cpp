#include "firmware/control/supervision/motor_check.hpp"

namespace inkwell::control {

bool MotorCheck::update(const Triple& current_A, const Triple& joint_speed_rad_per_s,
                        const std::array<Resistance, 3>& resistances, const Triple& back_emf_Vs_per_rad) {
  const Unexplained deviation = unexplained(voltage_V, loss, current_A[motor], joint_speed_rad_per_s[motor],
                                            resistances[motor], back_emf_Vs_per_rad[motor]);
  const float sum_V = beyond_V[motor] + deviation.voltage_V - deviation.tolerance_V;
  beyond_V[motor] = 0.0f;
  if (!(sum_V > 0.0f)) [[likely]]
    return true;
  beyond_V[motor] = sum_V;
  return sum_V <= tolerance_sum_V;
}

}  // namespace inkwell::control
