// Detects an encoder with one dead wire.
//
// Counting needs alternating edges on both wires. With one dead wire (broken, shorted or stuck), the count alternates
// between two neighboring values while the joint moves. The count of a healthy encoder alternates if the arm vibrates
// at an edge. The rate of the changes distinguishes a dead wire from a vibration.
//
// The bound is 120 changes in 0.1 s, which corresponds to a vibration of 600 Hz across an edge. Normal vibrations are
// slower. A program's force alternates at 500 Hz at most, so it causes at most 100 changes in 0.1 s. An arm of 45 g at
// a wall of 3000 N/m vibrates at 41 Hz. At 600 Hz, a force of 8 N moves the probe by 0.013 mm, which is a quarter of a
// count. A hand tremor moves the arm away from an edge within 0.1 s.
//
// Input filters and Schmitt triggers prevent chatter at an edge.
//
// With one dead wire, a joint at 1 rad/s causes 125 to 150 changes in 0.1 s. The check therefore detects a dead wire at
// probe speeds of 0.15 m/s or more.
#pragma once

#include <cstdint>

#include "firmware/control/signal_path/conditioning.hpp"

namespace inkwell::control {

struct EncoderWire {
  static constexpr std::uint32_t dead_changes = 120;
  static constexpr std::uint32_t within_periods = periods_in(0.1f);

  std::uint16_t count = 0, before = 0;  ///< present timer count, and the last timer count that was different
  std::uint32_t changes = 0;            ///< number of changes between these two counts
  std::uint32_t since_periods = 0;

  /// Checks one reading at period `now_periods`. Period numbers may be skipped and may wrap. Returns true after
  /// `dead_changes` changes between two neighboring counts within `within_periods`. Counting then restarts. Edges are
  /// missed if they are closer together than the readings, but a fast joint still causes enough changes.
  bool detect_dead_wire(std::uint16_t timer_count, std::uint32_t now_periods) {
    if (timer_count == count) return false;
    const bool goes_back = timer_count == before;
    const bool in_time = now_periods - since_periods <= within_periods;
    const auto step = static_cast<std::uint16_t>(timer_count - count);
    const bool to_neighbour = step == 1 || step == 0xFFFF;
    before = count;
    count = timer_count;
    if (changes == 0 || !goes_back || !in_time) {
      changes = 0;
      since_periods = now_periods;
    }
    changes += to_neighbour ? 1 : 0;
    if (changes < dead_changes) return false;
    changes = 0;
    return true;
  }
};

}  // namespace inkwell::control
