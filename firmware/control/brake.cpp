#include <control/brake.hpp>

#include <cmath>

namespace inkwell::control {

namespace {

constexpr protocol::Watches gentle =
    protocol::watches([](const auto& row) { return row.off == protocol::Off::brake_gently; });

}  // namespace

void advance(Brake& brake, float speed_squared_m2_per_s2, protocol::Watches found) {
  if (!brake.is_on()) return;
  // A speed that is no number is not above it either.
  const bool is_fast = speed_squared_m2_per_s2 > Brake::speed_m_per_s * Brake::speed_m_per_s;
  brake.remaining_periods = is_fast && may_brake(found) ? brake.remaining_periods - 1 : 0;
  if ((found & gentle) != 0) brake.is_gentle = true;
}

bool shorts(const Brake& brake, const Triple& current_A, const Triple& gentle_A) {
  if (!brake.is_on() || !brake.is_gentle) return brake.is_on();
  for (std::size_t i = 0; i < 3; ++i)
    if (!(std::fabs(current_A[i]) <= gentle_A[i])) return false;
  return true;
}

}  // namespace inkwell::control
