// The motors' own voltage brakes the arm when a fault takes the force away while it moves.
//
// With all low sides on, each motor drives a current through its own resistance that works against its motion, as a
// damper does, and nothing but heat comes of it. It needs no controller, so it is what is left to do for an arm that a
// fault has let loose; a bridge or a current that cannot be trusted is better left alone.
#pragma once

#include <cstdint>

#include <control/conditioning.hpp>
#include <protocol/supervision.hpp>

namespace inkwell::control {

struct Brake {
  /// Below it the arm coasts: the heaviest arm of the descriptions then holds less than a millijoule.
  static constexpr float speed_m_per_s = 0.1f;
  static constexpr std::uint32_t duration_maximum_periods = periods_in(0.5f);

  std::uint32_t remaining_periods = 0;

  /// A fault has taken the force away.
  void begin() { remaining_periods = duration_maximum_periods; }
  bool is_on() const { return remaining_periods != 0; }
};

/// Whether the motors may be shorted although these are found: none of them says that the motors have to coast.
constexpr bool may_brake(protocol::Watches found) {
  return (found & protocol::watches([](const auto& row) { return row.off == protocol::Off::coast; })) == 0;
}

/// One control period, that in which it begins as well. `speed_squared_m2_per_s2`: of the probe; `found`: by the
/// supervisor.
void advance(Brake& brake, float speed_squared_m2_per_s2, protocol::Watches found);

}  // namespace inkwell::control
