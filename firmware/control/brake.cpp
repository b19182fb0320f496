#include <control/brake.hpp>

namespace inkwell::control {

void advance(Brake& brake, float speed_squared_m2_per_s2, protocol::Watches found) {
  if (!brake.is_on()) return;
  // A speed that is no number is not above it either.
  const bool is_fast = speed_squared_m2_per_s2 > Brake::speed_m_per_s * Brake::speed_m_per_s;
  brake.remaining_periods = is_fast && may_brake(found) ? brake.remaining_periods - 1 : 0;
}

}  // namespace inkwell::control
