#include "firmware/control/supervision/brake.hpp"

#include <cmath>

namespace inkwell::control {

namespace {

constexpr protocol::Conditions gentle =
    protocol::conditions([](const auto& row) { return row.off == protocol::Off::brake_gently; });

}  // namespace

void Brake::advance(float speed_squared_m2_per_s2, protocol::Conditions found) {
  if (!is_on()) return;
  // NaN does not count as a fast speed.
  const bool is_fast = speed_squared_m2_per_s2 > speed_m_per_s * speed_m_per_s;
  remaining_periods = is_fast && may_brake(found) ? remaining_periods - 1 : 0;
  if ((found & gentle).any()) is_gentle = true;
}

bool Brake::shorts(const Triple& current_A, const Triple& limit_A) const {
  const float part = is_gentle ? gentle_part : 1.0f;
  bool may_short = is_on();
  for (std::size_t i = 0; i < 3; ++i) may_short = may_short && std::fabs(current_A[i]) <= part * limit_A[i];
  return may_short;
}

}  // namespace inkwell::control
