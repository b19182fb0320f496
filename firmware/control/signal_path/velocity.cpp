#include "firmware/control/signal_path/velocity.hpp"

#include <cmath>

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

namespace {

/// No arm moves this far within `rest_periods`. This bound keeps the following products within 32 bits.
constexpr std::int32_t farthest_counts = 65'536;
static_assert(2LL * (farthest_counts + 1) * SpeedEstimate::rest_periods < 0x7FFFFFFF);

/// Slope in half counts per period, as a fraction. Cross-multiplication compares fractions exactly and without
/// division.
struct Slope {
  std::int32_t half_counts;
  std::int32_t periods;
};

bool less(const Slope& a, const Slope& b) { return a.half_counts * b.periods < b.half_counts * a.periods; }

/// Returns the slope of the longest window that a line approximates within the tolerance.
// Inlining would duplicate the code of the caller.
[[gnu::noinline]] Slope fit_line(const SpeedEstimate& estimate, const EncoderEdge& head) {
  const float speed = estimate.counts_per_period;
  const std::int32_t tolerance = speed > -0.5f && speed < 0.5f ? 1 : 2;  // half counts
  Slope line{0, 1};
  Slope lowest{-1, 0};  // no bound yet
  Slope highest{1, 0};
  std::uint32_t index = estimate.newest;
  for (std::uint32_t left = estimate.remembered; left > 0; --left) {
    const EncoderEdge& edge = estimate.edges[index];
    index = index == 0 ? SpeedEstimate::capacity - 1 : index - 1;
    const std::uint32_t age_periods = head.period - edge.period;
    const std::int32_t distance_counts = head.boundary - edge.boundary;
    if (age_periods > SpeedEstimate::rest_periods || distance_counts > farthest_counts ||
        distance_counts < -farthest_counts)
      break;
    const auto age = static_cast<std::int32_t>(age_periods);
    const Slope candidate{2 * distance_counts, age};
    if (less(candidate, lowest) || less(highest, candidate)) break;
    line = candidate;
    const bool whole_cycle =
        distance_counts >= SpeedEstimate::enough_counts || distance_counts <= -SpeedEstimate::enough_counts;
    if (whole_cycle && age_periods >= SpeedEstimate::enough_periods) break;
    const Slope low{2 * distance_counts - tolerance, age};
    const Slope high{2 * distance_counts + tolerance, age};
    if (less(lowest, low)) lowest = low;
    if (less(high, highest)) highest = high;
  }
  return line;
}

void remember(SpeedEstimate& estimate, const EncoderEdge& edge) {
  estimate.newest = estimate.newest + 1 == SpeedEstimate::capacity ? 0 : estimate.newest + 1;
  estimate.edges[estimate.newest] = edge;
  if (estimate.remembered < SpeedEstimate::capacity) ++estimate.remembered;
}

/// Limits the speed to one count divided by the time since the last edge. Call this function in each period without an
/// edge.
void decay(SpeedEstimate& estimate, std::uint32_t silent_periods) {
  if (silent_periods >= SpeedEstimate::rest_periods) {
    estimate.remembered = 0;
    estimate.head_waits = false;
    estimate.counts_per_period = 0.0f;
    return;
  }
  // The speed falls in steps of 1/16, because unchanged values need fewer bytes in scope frames.
  constexpr float step = 1.0f + 1.0f / 16.0f;
  const float speed = estimate.counts_per_period;
  const auto silent = static_cast<float>(silent_periods);
  if (!(std::fabs(speed * silent) > step)) return;
  const float bound = reciprocal(silent);
  estimate.counts_per_period = speed > 0.0f ? bound : -bound;
}

}  // namespace

void update(SpeedEstimate& estimate, std::int32_t counts, std::uint32_t period, bool may_fit) {
  const std::int32_t before = estimate.counts;
  if (counts == before) {
    decay(estimate, period - estimate.head.period);
  } else {
    const std::int32_t direction = counts > before ? 1 : -1;
    const bool restarts = estimate.remembered == 0 || direction != estimate.direction;
    estimate.counts = counts;
    estimate.direction = direction;
    estimate.head = {period, direction > 0 ? counts : counts + 1};
    estimate.head_waits = !restarts;
    if (restarts) {
      estimate.remembered = 0;
      estimate.counts_per_period = 0.0f;
      remember(estimate, estimate.head);
    }
  }
  if (!estimate.head_waits || !may_fit) return;
  estimate.head_waits = false;
  const Slope line = fit_line(estimate, estimate.head);
  estimate.counts_per_period =
      0.5f * static_cast<float>(line.half_counts) * reciprocal(static_cast<float>(line.periods));
  if (estimate.head.period - estimate.edges[estimate.newest].period >= SpeedEstimate::spacing_periods)
    remember(estimate, estimate.head);
}

}  // namespace inkwell::control
