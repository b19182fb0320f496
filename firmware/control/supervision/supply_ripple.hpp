// Detects an oscillating bridge supply. Possible causes are a worn bulk capacitor, a loose plug, an unstable power
// supply or a failed rectifier diode.
//
// The frequency of an oscillation distinguishes a fault from normal operation. A step, a sag or a spike exceeds the
// bound at most twice, at the start and at the end. After a step, the slow mean follows the voltage. A hand that swings
// the arm reverses the motor power ten times per second. A force of 8 N at 40 Hz accelerates 45 g to 1.1 m/s, which
// corresponds to 27 mJ. An energy of 27 mJ raises the voltage of a 2200 uF capacitor at 18 V by 0.7 V. At 100 Hz, the
// voltage rise is 0.1 V. The losses of 41 W in the motor resistance lower the supply voltage by 0.3 V. The sum of these
// voltage changes is half of the bound.
//
// The voltage divider and its capacitor form a low-pass filter with a time constant of 0.9 ms. The filter passes 98 %
// of the amplitude at 35 Hz and 87 % at 100 Hz.
//
// The check uses only integers. If the main loop used floats, every interrupt would save the floating-point registers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/conditioning.hpp"

namespace inkwell::control {

struct SupplyRipple {
  /// An oscillation of 35 Hz or more causes this number of alternating excursions within `within_periods`.
  static constexpr std::size_t alternations = 8;
  static constexpr std::uint32_t within_periods = periods_in(0.1f);
  /// Time constant of the mean. The mean follows a voltage step, but not an oscillation. The value is a power of two,
  /// so that the division is a shift.
  static constexpr std::int32_t mean_periods = 2048;

  std::int32_t tolerance_counts;  ///< protocol::supply_ripple_V in converter counts, in either direction from the mean
  std::int32_t mean_counts = -1;  ///< mean times mean_periods; below 0 before the first reading
  bool above = false, below = false;  ///< whether the last excursion was above or below the bounds
  std::uint32_t read_at_periods = 0;
  std::array<std::uint32_t, alternations> changed_at_periods{};  ///< ring of the newest side changes
  std::size_t next = 0, changes = 0;                             ///< next ring position; number of valid entries

  /// Checks one reading at period `now_periods`. Period numbers may be skipped and may wrap. Returns true while the
  /// last `alternations` alternating excursions are within `within_periods`.
  bool detect_ripple(std::uint16_t supply_counts, std::uint32_t now_periods) {
    if (mean_counts < 0) mean_counts = supply_counts * mean_periods;
    constexpr auto all = static_cast<std::uint32_t>(mean_periods);
    const auto passed_periods = static_cast<std::int32_t>(std::min(now_periods - read_at_periods, all));
    read_at_periods = now_periods;
    const std::int32_t beyond_counts = supply_counts - mean_counts / mean_periods;
    mean_counts += beyond_counts * passed_periods;

    const bool is_above = beyond_counts > tolerance_counts, is_below = beyond_counts < -tolerance_counts;
    if ((is_above && below) || (is_below && above)) {
      changed_at_periods[next] = now_periods;
      next = (next + 1) % alternations;
      changes = std::min(changes + 1, alternations);
    }
    if (is_above || is_below) {
      above = is_above;
      below = is_below;
    }
    if (changes == 0) return false;
    // In a full ring, the oldest entry is overwritten next.
    const std::size_t oldest = (next + alternations - changes) % alternations;
    if (now_periods - changed_at_periods[oldest] > within_periods) --changes;
    return changes == alternations;
  }
};

}  // namespace inkwell::control
