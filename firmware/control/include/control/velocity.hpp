// Speed of a joint from its encoder, usable at every control period.
//
// One count in one period of 50 us would be 1.1 m/s at the probe, so a difference of samples is of no
// use. This is a first-order adaptive window (Janabi-Sharifi, Hayward, Chen, IEEE T-CST 2000) on the
// encoder's EDGES instead of its samples: an edge is seen within a period of the crossing, so its position
// is known to within what the joint moves in one period, not merely to within a count. Of the edges
// remembered, the window goes back to the oldest whose straight line to the newest passes every edge
// between within a tolerance that constant speed always keeps: half a count up to half a count a period,
// one count above. A window that holds a whole quadrature cycle, in which the encoder's phase errors cancel,
// and is long enough for an error below 2 % grows no further: it would only add lag. Slow motion then gives
// long windows and quiet values, acceleration short ones and little lag.
//
// Between edges the value stays as it is, unless the joint has been silent for longer than the value
// allows: n periods without an edge bound the speed by 1/n counts a period. A reversal is a speed of
// zero and starts the window anew, so one count to and fro reads zero.
#pragma once

#include <array>
#include <cstdint>

#include <control/vector.hpp>

namespace inkwell::control {

/// A boundary between two counts, and the control period in which the encoder was first seen beyond it.
struct EncoderEdge {
  std::uint32_t period;
  std::int32_t boundary;
};

/// What the estimate of one joint remembers.
struct SpeedEstimate {
  static constexpr std::uint32_t capacity = 6;
  /// Edges nearer than this to the last remembered one are used but not remembered, so that six reach back
  /// 3 ms at high speed, where every period has an edge.
  static constexpr std::uint32_t spacing_periods = 11;
  /// An edge's time is uncertain by one period, so a window of this length is right to one in 64.
  static constexpr std::uint32_t enough_periods = 64;
  static constexpr std::int32_t enough_counts = 4;
  /// Half a second without an edge is rest.
  static constexpr std::uint32_t rest_periods = 10'000;

  std::array<EncoderEdge, capacity> edges{};  ///< ring
  std::uint32_t newest = 0;                   ///< index of the edge remembered last
  std::uint32_t remembered = 0;               ///< 0..capacity
  EncoderEdge head{};                         ///< the last edge, remembered or not
  bool head_waits = false;                    ///< for its turn to be fitted
  std::int32_t counts = 0;
  std::int32_t direction = 0;  ///< of the last edge: +1, -1, or 0 before the first
  float counts_per_period = 0.0f;
};

/// Lets a new estimate start at rest at these counts.
constexpr void start(SpeedEstimate& estimate, std::int32_t counts, std::uint32_t period) {
  estimate.counts = counts;
  estimate.head.period = period;
}

/// Takes in the counts of one control period. Where `may_fit` is false a new edge is kept and fitted in the
/// next period that may, so that joints can take turns and only one pays for a fit in any period: at most
/// `capacity` short steps, no divide.
void update(SpeedEstimate& estimate, std::int32_t counts, std::uint32_t period, bool may_fit = true);

}  // namespace inkwell::control
