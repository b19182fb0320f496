// Random motion of a hand at bodies with thin walls, in the closed loop.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/contact/closed_loop.hpp"
#include "tests/host/contact/fall_through.hpp"

namespace inkwell::closed_loop {

/// Properties of the wall in addition to its stiffness.
enum class Wall : std::uint8_t { frictionless, friction, friction_and_damping };
inline constexpr unsigned wall_kinds = 3;

/// After a gap, or when the tip slips off an edge, the proxy of the board may be beyond the wall until the next models
/// have moved it back. A proxy that stays there for a longer time has fallen through.
inline constexpr unsigned fallen_periods = protocol::servo_rate_Hz / 4;
/// Bound of the rise of the force in a period, in addition to k dx + b dv.
inline constexpr double rise_N = 0.005;

struct Visit {
  Wall wall = Wall::frictionless;
  unsigned periods = 0;
  unsigned touching_periods = 0;
  unsigned beyond_periods = 0;  ///< the center of the proxy was beyond the wall
  unsigned longest_beyond_periods = 0;
  double deepest_m = 0;  ///< largest distance of the center of the proxy beyond the wall
  std::uint64_t models = 0;
  /// Largest rise of the force in a period, minus k dx + b dv. A damper adds its whole force at the start of a contact,
  /// and the limit of the force change spreads a rise over several periods.
  double largest_rise_N = 0;
  unsigned rises = 0;  ///< periods with a larger rise than rise_N

  bool has_fallen() const { return longest_beyond_periods >= fallen_periods; }
};

/// A hand moves at a body for this board time, with lost reports and gaps. `number` decides all random values: body,
/// side, tip, wall, hand and path. Number modulo wall_kinds is the wall.
Visit visit(const std::vector<contact_trial::HollowBody>& bodies, std::uint64_t number, double board_s);

}  // namespace inkwell::closed_loop
