// Whether an encoder has lost one of its two wires.
//
// A count needs an edge on each wire in turn. With one wire dead (broken, shorted, or a channel that stands) every edge
// of the other one takes the count on by one and the next edge takes it back: it goes to and fro between two neighbours
// however far the joint moves. An encoder that stands at an edge and is shaken looks the same, so what tells them apart
// is how fast that goes.
//
// The bound is 120 changes in 0.1 s: an edge that is crossed to and fro 600 times a second. What may honestly shake the
// arm there is slower. A program gives a force each millisecond, so it turns it round 500 times a second at most, which
// makes 100 changes. A wall or a shape that buzzes does so at the arm's and the wall's own frequency: 3000 N/m and 45 g
// make 41 Hz. A current loop could ring faster, but hardly moves anything: at 600 Hz the full 8 N move the probe by
// 0.013 mm, a quarter of a count, and a hand's tremor takes the arm off an edge within 0.1 s. The inputs' filters and
// Schmitt triggers keep an edge that stands from chattering by itself.
//
// A dead wire leaves half of the edges. A joint that turns at 1 rad/s goes through some 2500 to 3000 counts a second
// and so makes 125 to 150 changes in 0.1 s: a motion of the probe by 0.15 m/s is noticed.
#pragma once

#include <cstdint>

#include <control/conditioning.hpp>

namespace inkwell::control {

struct EncoderWire {
  static constexpr std::uint32_t dead_changes = 120;
  static constexpr std::uint32_t within_periods = periods_in(0.1f);

  std::uint16_t count = 0, before = 0;  ///< the timer's, and the one that it had before that
  std::uint32_t changes = 0;            ///< between these two
  std::uint32_t since_periods = 0;
};

/// One look, at `now_periods` of the control period's count, which may skip some and wraps. True when the count has
/// changed so often between two neighbours, within that time; then it is counted anew. Edges that come closer together
/// than the looks are seen in part, which is enough: the faster the joint turns, the more of them there are.
inline bool is_dead(EncoderWire& wire, std::uint16_t timer_count, std::uint32_t now_periods) {
  if (timer_count == wire.count) return false;
  const bool goes_back = timer_count == wire.before;
  const bool in_time = now_periods - wire.since_periods <= EncoderWire::within_periods;
  const auto step = static_cast<std::uint16_t>(timer_count - wire.count);
  const bool to_neighbour = step == 1 || step == 0xFFFF;
  wire.before = wire.count;
  wire.count = timer_count;
  if (wire.changes == 0 || !goes_back || !in_time) {
    wire.changes = 0;
    wire.since_periods = now_periods;
  }
  wire.changes += to_neighbour ? 1 : 0;
  if (wire.changes < EncoderWire::dead_changes) return false;
  wire.changes = 0;
  return true;
}

}  // namespace inkwell::control
