#include <control/velocity.hpp>

#include <control/trigonometry.hpp>

namespace inkwell::control {

namespace {

/// Farther than any arm moves within `rest_periods`; keeps the products below within 32 bits.
constexpr std::int32_t farthest_counts = 65'536;
static_assert(static_cast<std::int64_t>(farthest_counts) * SpeedEstimate::rest_periods < 0x7FFFFFFF);

/// Fraction of counts over periods; compared by cross-multiplication, which is exact and needs no divide.
struct Slope {
  std::int32_t counts;
  std::int32_t periods;
};

bool less(const Slope& a, const Slope& b) { return a.counts * b.periods < b.counts * a.periods; }

/// Slope of the longest window whose line passes all of its edges within one count.
Slope longest_line(const SpeedEstimate& estimate, const EncoderEdge& head) {
  Slope line{0, 1};
  Slope lowest{-1, 0};  // no bound yet
  Slope highest{1, 0};
  for (std::uint32_t back = 0; back < estimate.remembered; ++back) {
    const EncoderEdge& edge =
        estimate.edges[(estimate.newest + SpeedEstimate::capacity - back) % SpeedEstimate::capacity];
    const std::uint32_t age_periods = head.period - edge.period;
    const std::int32_t distance_counts = head.boundary - edge.boundary;
    if (age_periods > SpeedEstimate::rest_periods || distance_counts > farthest_counts ||
        distance_counts < -farthest_counts)
      break;
    const auto age = static_cast<std::int32_t>(age_periods);
    const Slope candidate{distance_counts, age};
    if (less(candidate, lowest) || less(highest, candidate)) break;
    line = candidate;
    const Slope low{distance_counts - 1, age};
    const Slope high{distance_counts + 1, age};
    if (less(lowest, low)) lowest = low;
    if (less(high, highest)) highest = high;
  }
  return line;
}

void remember(SpeedEstimate& estimate, const EncoderEdge& edge) {
  estimate.newest = (estimate.newest + 1) % SpeedEstimate::capacity;
  estimate.edges[estimate.newest] = edge;
  if (estimate.remembered < SpeedEstimate::capacity) ++estimate.remembered;
}

/// No edge came in this period: bounds the speed by one count in the time of silence.
void decay(SpeedEstimate& estimate, std::uint32_t silent_periods) {
  if (silent_periods >= SpeedEstimate::rest_periods) {
    estimate.remembered = 0;
    estimate.counts_per_period = 0.0f;
    return;
  }
  // Steps of a sixteenth instead of a little in every period: a value that rests is cheap to stream.
  constexpr float step = 1.0f + 1.0f / 16.0f;
  const float speed = estimate.counts_per_period;
  const auto silent = static_cast<float>(silent_periods);
  const float expected_counts = speed * silent;
  if (expected_counts > step) estimate.counts_per_period = reciprocal(silent);
  if (expected_counts < -step) estimate.counts_per_period = -reciprocal(silent);
}

}  // namespace

SpeedEstimate start_speed_estimate(std::int32_t counts, std::uint32_t period) {
  SpeedEstimate estimate;
  estimate.counts = counts;
  estimate.last_edge_period = period;
  return estimate;
}

void update(SpeedEstimate& estimate, std::int32_t counts, std::uint32_t period) {
  const std::uint32_t silent_periods = period - estimate.last_edge_period;
  if (counts == estimate.counts) {
    decay(estimate, silent_periods);
    return;
  }
  const std::int32_t direction = counts > estimate.counts ? 1 : -1;
  const EncoderEdge head{period, direction > 0 ? counts : counts + 1};
  const bool first = estimate.remembered == 0 || direction != estimate.direction;
  estimate.counts = counts;
  estimate.direction = direction;
  estimate.last_edge_period = period;
  if (first) {
    estimate.remembered = 0;
    estimate.counts_per_period = 0.0f;
    remember(estimate, head);
    return;
  }
  const Slope line = longest_line(estimate, head);
  estimate.counts_per_period = static_cast<float>(line.counts) * reciprocal(static_cast<float>(line.periods));
  if (period - estimate.edges[estimate.newest].period >= SpeedEstimate::spacing_periods) remember(estimate, head);
}

}  // namespace inkwell::control
