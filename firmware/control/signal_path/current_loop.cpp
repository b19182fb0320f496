#include "firmware/control/signal_path/current_loop.hpp"

namespace inkwell::control {

CurrentLoopStep regulate(const CurrentLoop& loop, float reference_A, float current_A, const CurrentLoopGains& gains,
                         const VoltageRange& range) {
  const float error_A = reference_A - current_A;
  const float integral_V = loop.integral_V + gains.half_integral_V_per_A * (error_A + loop.error_A);
  const float voltage_V = gains.proportional_V_per_A * error_A + integral_V;
  const float bounded_V = clamp(voltage_V, range.least_V, range.most_V);
  const bool winds_up = (integral_V - loop.integral_V) * (voltage_V - bounded_V) > 0.0f;
  return {{winds_up ? loop.integral_V : integral_V, error_A}, bounded_V};
}

}  // namespace inkwell::control
