// Whether an encoder stands still against its motor's current.
//
// Nothing but its encoder says where a joint is, so one that is stuck looks like a joint that is held. What tells them
// apart is that nothing holds an arm so well: a motor that presses otherwise than before turns the joint, if only by
// what the arm's cables and links and a hand or a stop give way. The stiffness of an Omni at the stylus is 1 to 2 N/mm,
// so a newton turns its joints by ten counts. Friction keeps a joint where it is as long as the force changes by no
// more than twice the friction, 0.5 N on an Omni.
//
// The bound is a change of 1.5 N at the end of the longer link with no more than a count to either side. An arm that
// has twice an Omni's friction and twice its stiffness still turns by more. A count to either side is what an encoder
// with one dead wire shows, too slowly for control/encoder_wire.hpp where the arm moves slowly.
//
// A sound joint bears one such change now and then: a hand that slides along a wall, or presses into it aslant, may
// pull by just as much less or more as the wall's force falls or rises, and friction holds the joint to the count. In
// an hour of random use on the virtual board no sound joint swung by 1 N more than twice in one standstill, and by 2 N
// more than once. Three of the bound are told: pressed, let go and pressed again, or 4.5 N more.
//
// An arm that turns round stands for a moment, and a wall's force may rise meanwhile: 30 ms and 0.5 A were seen. So
// changes count from 0.1 s on after the joint came to stand. The current is that of some ten milliseconds: a force that
// turns round faster than the arm can follow leaves no trace in it.
//
// Only the inkwell holds better. While the stylus is in it nothing is compared.
#pragma once

#include <algorithm>
#include <cstdint>

#include <control/conditioning.hpp>

namespace inkwell::control {

struct StuckEncoder {
  /// The change of force at the end of the longer link that turns every joint but by a coincidence.
  static constexpr float moving_force_N = 1.5f;
  static constexpr unsigned bearable_changes = 2;
  static constexpr std::uint32_t bearable_counts = 1;
  static constexpr std::uint32_t settle_periods = periods_in(0.1f);
  /// Of a new reading, of which there is one in three periods at best: a low-pass of 9.6 ms.
  static constexpr float weight = 1.0f / 64.0f;

  std::int32_t counts = 0;          ///< where it stands
  std::uint32_t since_periods = 0;  ///< since when
  float current_A = 0.0f;           ///< of its motor, filtered
  float least_A = 0.0f;             ///< since the joint had settled, or since the last change
  float most_A = 0.0f;
  unsigned changes = 0;  ///< in this standstill
};

/// One look at an encoder and its motor's current, at `now_periods` of the control period's count. True while it stands
/// although the current has changed by more than `moving_A` more often than a sound joint bears. `held` says that the
/// joint may stand: it is then looked at anew.
inline bool is_stuck(StuckEncoder& encoder, std::int32_t counts, float current_A, std::uint32_t now_periods, bool held,
                     float moving_A) {
  encoder.current_A += StuckEncoder::weight * (current_A - encoder.current_A);
  const std::uint32_t away =
      static_cast<std::uint32_t>(counts) - static_cast<std::uint32_t>(encoder.counts) + StuckEncoder::bearable_counts;
  if (held || away > 2 * StuckEncoder::bearable_counts) {
    encoder.counts = counts;
    encoder.since_periods = now_periods;
    encoder.changes = 0;
  }
  const bool settles = now_periods - encoder.since_periods < StuckEncoder::settle_periods;
  encoder.least_A = std::min(encoder.least_A, encoder.current_A);
  encoder.most_A = std::max(encoder.most_A, encoder.current_A);
  const bool changed = !settles && encoder.most_A - encoder.least_A > moving_A;
  if (settles || changed) encoder.least_A = encoder.most_A = encoder.current_A;
  if (changed) ++encoder.changes;
  return encoder.changes > StuckEncoder::bearable_changes;
}

}  // namespace inkwell::control
