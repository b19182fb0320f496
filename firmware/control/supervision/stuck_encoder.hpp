// Detects an encoder whose count does not follow changes of the motor current.
//
// A stuck encoder and a blocked joint both have a constant count. A torque change turns even a blocked joint slightly,
// because cables, links, stops and hands are elastic. At a stiffness of 1 to 2 N/mm, the joints of an Omni turn by
// about ten counts per newton. Friction can block a joint of an Omni up to a force change of 0.5 N.
//
// A change of 1.5 N at the end of the longer link must move the encoder by more than one count. At 1.5 N, an arm with
// twice the friction and twice the stiffness of an Omni moves by more than one count. On slow arms, this check also
// detects a dead encoder wire.
//
// A healthy joint occasionally does not move when the force changes by 1.5 N. A hand may balance the change of a wall
// force. In one hour of random use in simulation, no stationary healthy joint had three changes of 1 N. The fault is
// raised after three changes of 1.5 N. A press, a release and a second press count as three changes. A force increase
// of 4.5 N counts as three changes.
//
// At a reversal, a healthy arm may be stationary for 30 ms while the current rises by 0.5 A. Current changes therefore
// count only after the joint has been stationary for 0.1 s. A low-pass filter of about 10 ms removes currents that
// alternate too fast to move the arm.
//
// The inkwell is too rigid for this check, so the check is inactive while the stylus is in the inkwell.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/control/signal_path/conditioning.hpp"

namespace inkwell::control {

struct StuckEncoder {
  /// Force change at the end of the longer link. A change of this size almost always turns every joint.
  static constexpr float moving_force_N = 1.5f;
  static constexpr unsigned tolerated_changes = 2;
  static constexpr std::uint32_t tolerance_counts = 1;
  static constexpr std::uint32_t settle_periods = periods_in(0.1f);
  /// Filter weight of a new reading. With one reading in three periods, the time constant of this low-pass filter is
  /// 9.6 ms.
  static constexpr float weight = 1.0f / 64.0f;

  std::int32_t counts = 0;          ///< count at which the encoder is stationary
  std::uint32_t since_periods = 0;  ///< start of the standstill
  float current_A = 0.0f;           ///< filtered motor current
  float least_A = 0.0f;             ///< least filtered current since the joint settled or since the last counted change
  float most_A = 0.0f;
  unsigned changes = 0;  ///< number of current changes in this standstill

  /// Checks an encoder and the current of its motor at period `now_periods`. Returns true if the motor current has
  /// changed three times by more than `moving_A` while the encoder was stationary. If `held` is true, the standstill
  /// time restarts.
  bool detect_stuck_encoder(std::int32_t now_counts, float now_A, std::uint32_t now_periods, bool held,
                            float moving_A) {
    current_A += weight * (now_A - current_A);
    const std::uint32_t away =
        static_cast<std::uint32_t>(now_counts) - static_cast<std::uint32_t>(counts) + tolerance_counts;
    if (held || away > 2 * tolerance_counts) {
      counts = now_counts;
      since_periods = now_periods;
      changes = 0;
    }
    const bool settles = now_periods - since_periods < settle_periods;
    least_A = std::min(least_A, current_A);
    most_A = std::max(most_A, current_A);
    const bool changed = !settles && most_A - least_A > moving_A;
    if (settles || changed) least_A = most_A = current_A;
    if (changed) ++changes;
    return changes > tolerated_changes;
  }
};

}  // namespace inkwell::control
