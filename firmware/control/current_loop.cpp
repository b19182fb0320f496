#include <control/current_loop.hpp>

namespace inkwell::control {

CurrentLoopStep regulate(const CurrentLoop& loop, float reference_A, float current_A, const CurrentLoopGains& gains,
                         float voltage_bound_V) {
  const float error_A = reference_A - current_A;
  const float integral_V = loop.integral_V + gains.half_integral_V_per_A * (error_A + loop.error_A);
  const float voltage_V = gains.proportional_V_per_A * error_A + integral_V;
  if (voltage_V > voltage_bound_V)
    return {{integral_V < loop.integral_V ? integral_V : loop.integral_V, error_A}, voltage_bound_V};
  if (voltage_V < -voltage_bound_V)
    return {{integral_V > loop.integral_V ? integral_V : loop.integral_V, error_A}, -voltage_bound_V};
  return {{integral_V, error_A}, voltage_V};
}

}  // namespace inkwell::control
