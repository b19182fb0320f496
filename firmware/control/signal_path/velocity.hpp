// Joint speed from the encoder, updated in every control period.
//
// One count per period corresponds to 1.1 m/s at the probe, so the difference of two samples is too coarse. The
// estimator is a first-order adaptive window (Janabi-Sharifi, Hayward, Chen, IEEE T-CST 2000) that uses encoder edges
// instead of samples. The position error of an edge is the joint motion of one period. The position error of a sample
// would be one count.
//
// A straight line connects the oldest edge and the newest edge of the window. All other edges of the window must be
// within a tolerance of the line. A constant speed never exceeds the tolerance. The tolerance is half a count at speeds
// up to half a count per period, and one count at higher speeds. The window grows until it contains a whole quadrature
// cycle and the error is below 2 %. The phase errors of the encoder cancel over a whole quadrature cycle. Slow motion
// results in long windows with little noise. Acceleration results in short windows with little lag.
//
// After n periods without an edge, the speed is at most 1/n counts per period. At a reversal the speed is set to zero
// and the window restarts. The estimate for a motion of one count back and forth is therefore zero.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// Boundary between two counts and the period in which the encoder crossed the boundary.
struct EncoderEdge {
  std::uint32_t period;
  std::int32_t boundary;
};

/// State of the speed estimate of one joint.
struct SpeedEstimate {
  static constexpr std::uint32_t capacity = 6;
  /// Shortest time between two stored edges. Six stored edges therefore cover about 3 ms at high speed.
  static constexpr std::uint32_t spacing_periods = 11;
  /// With an edge time error of one period, the speed error is 1/64.
  static constexpr std::uint32_t enough_periods = 64;
  static constexpr std::int32_t enough_counts = 4;
  /// After half a second without an edge the speed is zero.
  static constexpr std::uint32_t rest_periods = 10'000;

  std::array<EncoderEdge, capacity> edges{};  ///< ring
  std::uint32_t newest = 0;                   ///< index of the last stored edge
  std::uint32_t remembered = 0;               ///< number of stored edges, 0..capacity
  EncoderEdge head{};                         ///< last edge, stored or not
  bool head_waits = false;                    ///< `head` is not fitted yet
  std::int32_t counts = 0;
  std::int32_t direction = 0;  ///< direction of the last edge: +1, -1, or 0 before the first edge
  float counts_per_period = 0.0f;

  /// Sets the first counts of a new estimate, whose speed is zero.
  constexpr void start(std::int32_t now_counts, std::uint32_t period) {
    counts = now_counts;
    head.period = period;
  }

  /// Processes the counts of one control period. If `may_fit` is false, a new edge is not fitted until the next period
  /// in which `may_fit` is true. The caller can thus limit each period to the fit of one joint. A fit needs at most
  /// `capacity` short steps and no division.
  void update(std::int32_t now_counts, std::uint32_t period, bool may_fit = true);

 private:
  void remember(const EncoderEdge& edge);
  /// Limits the speed to one count divided by the time since the last edge. Call this function in each
  /// period without an edge.
  void decay(std::uint32_t silent_periods);
};

}  // namespace inkwell::control
