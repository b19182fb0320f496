#include "firmware/control/supervision/brake.hpp"

#include <cmath>

namespace inkwell::control {

namespace {

constexpr protocol::Conditions gentle =
    protocol::conditions([](const auto& row) { return row.off == protocol::Off::brake_gently; });

}  // namespace

void advance(Brake& brake, float speed_squared_m2_per_s2, protocol::Conditions found) {
  if (!brake.is_on()) return;
  // NaN does not count as a fast speed.
  const bool is_fast = speed_squared_m2_per_s2 > Brake::speed_m_per_s * Brake::speed_m_per_s;
  brake.remaining_periods = is_fast && may_brake(found) ? brake.remaining_periods - 1 : 0;
  if ((found & gentle).any()) brake.is_gentle = true;
}

bool shorts(const Brake& brake, const Triple& current_A, const Triple& limit_A) {
  const float part = brake.is_gentle ? Brake::gentle_part : 1.0f;
  bool is_on = brake.is_on();
  for (std::size_t i = 0; i < 3; ++i) is_on = is_on && std::fabs(current_A[i]) <= part * limit_A[i];
  return is_on;
}

}  // namespace inkwell::control
