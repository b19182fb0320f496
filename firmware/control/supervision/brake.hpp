// Electrical braking of a moving arm after a fault has switched the force off.
//
// With all low sides on, the motors are shorted and act as dampers. The back EMF of each motor drives a current that
// opposes the motion. The kinetic energy becomes heat. Released motors return a little energy to the supply. Braking
// needs no current control, so it works after most faults. The brake is not used if a bridge or a current measurement
// may be faulty.
//
// The force of a damper increases with the speed of the arm. A motor current above the current at the force limit
// therefore releases the motors for one period. Gentle braking uses a lower current bound. After a release, the
// currents decay within microseconds.
#pragma once

#include <cstdint>

#include "firmware/control/signal_path/conditioning.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::control {

struct Brake {
  /// Below this speed the arm coasts. At this speed, the kinetic energy of the heaviest supported arm is less than 1
  /// mJ.
  static constexpr float speed_m_per_s = 0.1f;
  static constexpr std::uint32_t duration_maximum_periods = periods_in(0.5f);
  /// Current bound of gentle braking, relative to Limits::brake_A. On an Omni, the average braking force of one motor
  /// is 0.3 to 0.6 N at up to 2 m/s.
  static constexpr float gentle_part = 0.15f;

  std::uint32_t remaining_periods = 0;
  bool is_gentle = false;

  /// Starts braking after a fault has switched the force off.
  void begin() { *this = {duration_maximum_periods, false}; }
  /// Call this function once per control period. `speed_squared_m2_per_s2` is the squared probe speed. `found` comes
  /// from the supervisor.
  void advance(float speed_squared_m2_per_s2, protocol::Conditions found);
  bool is_on() const { return remaining_periods != 0; }
  /// Returns true if the motors are shorted in this period. `limit_A` is Limits::brake_A. A NaN current releases the
  /// motors.
  bool shorts(const Triple& current_A, const Triple& limit_A) const;
};

/// Returns true if braking is permitted with these faults.
constexpr bool may_brake(protocol::Conditions found) {
  return !(found & protocol::conditions([](const auto& row) { return row.off == protocol::Off::coast; })).any();
}

}  // namespace inkwell::control
