// Whether the supply of the bridges swings up and down again and again: a bulk capacitor that is worn, a plug that is
// loose, a supply that hunts or has lost a diode.
//
// A swing is told from what a sound supply does by how often it turns, not by how far it goes. A step, a sag or a spike
// goes beyond the bound once, and its way back is the second time at most; the slow mean then follows. An arm that is
// swung by a hand turns its motors' power round ten times a second. A program or a force law can turn a force round
// faster, but the faster it is the less energy there is in a turn: 8 N, the largest force, move 45 g to and fro at 40
// Hz with at most 1.1 m/s or 27 mJ, with which 2200 uF rise from 18 V by 0.7 V, and at 100 Hz by 0.1 V. What the
// motors' resistance takes beside that, 41 W, pulls the supply down by 0.3 V. Together that is half of the bound to
// either side; a test looks at it on the simulated board.
//
// The reading comes through a divider with a capacitor, a low-pass of 0.9 ms, which leaves 98 % of a swing of 35 Hz and
// 87 % of one of 100 Hz.
//
// Whole numbers only, for the main loop: each interrupt would save the floats of what it interrupts.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <control/conditioning.hpp>

namespace inkwell::control {

struct SupplyRipple {
  /// So many changes of the side within that time are a swing of 35 Hz or more.
  static constexpr std::size_t alternations = 8;
  static constexpr std::uint32_t within_periods = periods_in(0.1f);
  /// Of the mean: as long, so that it stays amid a swing and has followed a step before the next turn of a hand. A
  /// power of two, by which a division is a shift.
  static constexpr std::int32_t mean_periods = 2048;

  std::int32_t bearable_counts;       ///< of the converter: protocol::supply_ripple_V from the mean, to either side
  std::int32_t mean_counts = -1;      ///< times mean_periods; below 0 before the first look
  bool above = false, below = false;  ///< where it was beyond the bound last
  std::uint32_t looked_at_periods = 0;
  std::array<std::uint32_t, alternations> changed_at_periods{};  ///< the side; the newest times, in a ring
  std::size_t next = 0, changes = 0;                             ///< place of the next one; how many of them count
};

/// One look, at `now_periods` of the control period's count, which may skip some and wraps. True while there were so
/// many changes within that time.
inline bool ripples(SupplyRipple& ripple, std::uint16_t supply_counts, std::uint32_t now_periods) {
  if (ripple.mean_counts < 0) ripple.mean_counts = supply_counts * SupplyRipple::mean_periods;
  constexpr auto all = static_cast<std::uint32_t>(SupplyRipple::mean_periods);
  const auto passed_periods = static_cast<std::int32_t>(std::min(now_periods - ripple.looked_at_periods, all));
  ripple.looked_at_periods = now_periods;
  const std::int32_t beyond_counts = supply_counts - ripple.mean_counts / SupplyRipple::mean_periods;
  ripple.mean_counts += beyond_counts * passed_periods;

  const bool above = beyond_counts > ripple.bearable_counts, below = beyond_counts < -ripple.bearable_counts;
  if ((above && ripple.below) || (below && ripple.above)) {
    ripple.changed_at_periods[ripple.next] = now_periods;
    ripple.next = (ripple.next + 1) % SupplyRipple::alternations;
    ripple.changes = std::min(ripple.changes + 1, SupplyRipple::alternations);
  }
  if (above || below) {
    ripple.above = above;
    ripple.below = below;
  }
  if (ripple.changes == 0) return false;
  // The oldest of a full ring is the next to be written over.
  const std::size_t oldest = (ripple.next + SupplyRipple::alternations - ripple.changes) % SupplyRipple::alternations;
  if (now_periods - ripple.changed_at_periods[oldest] > SupplyRipple::within_periods) --ripple.changes;
  return ripple.changes == SupplyRipple::alternations;
}

}  // namespace inkwell::control
