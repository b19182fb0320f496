// The motors' own voltage brakes the arm when a fault takes the force away while it moves.
//
// With all low sides on, each motor drives a current through its own resistance that works against its motion, as a
// damper does, and nothing but heat comes of it; let go in between, it feeds a little into the supply. It needs no
// controller, so it is what is left to do for an arm that a fault has let loose; a bridge or a current that cannot be
// trusted is better left alone.
//
// A damper resists the more the faster a hand swings the arm. So a control period in which a current is larger than the
// force limit takes is one in which the motors are let go; where the brake has to be gentle, than a part of it takes.
// Their currents are gone after some microseconds then, and take a period or more to come back. A brake that was gentle
// stays so, however fast the arm gets: it is the hand that makes it fast.
#pragma once

#include <cstdint>

#include <control/conditioning.hpp>
#include <protocol/supervision.hpp>

namespace inkwell::control {

struct Brake {
  /// Below it the arm coasts: the heaviest arm of the descriptions then holds less than a millijoule.
  static constexpr float speed_m_per_s = 0.1f;
  static constexpr std::uint32_t duration_maximum_periods = periods_in(0.5f);
  /// Of Limits::brake_A. Computed for an Omni at its usual limit, one motor resists with 0.3 to 0.6 N on the average up
  /// to 2 m/s, with 1.1 N at 3.
  static constexpr float gentle_part = 0.15f;

  std::uint32_t remaining_periods = 0;
  bool is_gentle = false;

  /// A fault has taken the force away.
  void begin() { *this = {duration_maximum_periods, false}; }
  bool is_on() const { return remaining_periods != 0; }
};

/// Whether the motors may be shorted although these are found: none of them says that the motors have to coast.
constexpr bool may_brake(protocol::Watches found) {
  return (found & protocol::watches([](const auto& row) { return row.off == protocol::Off::coast; })) == 0;
}

/// One control period, that in which it begins as well. `speed_squared_m2_per_s2`: of the probe; `found`: by the
/// supervisor.
void advance(Brake& brake, float speed_squared_m2_per_s2, protocol::Watches found);

/// Whether the motors are shorted in this period. `limit_A`: Limits::brake_A. A current that is no number lets them go.
bool shorts(const Brake& brake, const Triple& current_A, const Triple& limit_A);

}  // namespace inkwell::control
