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

}  // namespace

void SpeedEstimate::remember(const EncoderEdge& edge) {
  newest = newest + 1 == capacity ? 0 : newest + 1;
  edges[newest] = edge;
  if (remembered < capacity) ++remembered;
}

void SpeedEstimate::decay(std::uint32_t silent_periods) {
  if (silent_periods >= rest_periods) {
    remembered = 0;
    head_waits = false;
    counts_per_period = 0.0f;
    return;
  }
  // The speed falls in steps of 1/16, because unchanged values need fewer bytes in scope frames.
  constexpr float step = 1.0f + 1.0f / 16.0f;
  const float speed = counts_per_period;
  const auto silent = static_cast<float>(silent_periods);
  if (!(std::fabs(speed * silent) > step)) return;
  const float bound = reciprocal(silent);
  counts_per_period = speed > 0.0f ? bound : -bound;
}

void SpeedEstimate::update(std::int32_t now_counts, std::uint32_t period, bool may_fit) {
  const std::int32_t before = counts;
  if (now_counts == before) {
    decay(period - head.period);
  } else {
    const std::int32_t new_direction = now_counts > before ? 1 : -1;
    const bool restarts = remembered == 0 || new_direction != direction;
    counts = now_counts;
    direction = new_direction;
    head = {period, new_direction > 0 ? now_counts : now_counts + 1};
    head_waits = !restarts;
    if (restarts) {
      remembered = 0;
      counts_per_period = 0.0f;
      remember(head);
    }
  }
  if (!head_waits || !may_fit) return;
  head_waits = false;
  const Slope line = fit_line(*this, head);
  counts_per_period = 0.5f * static_cast<float>(line.half_counts) * reciprocal(static_cast<float>(line.periods));
  if (head.period - edges[newest].period >= spacing_periods) remember(head);
}

}  // namespace inkwell::control
