#include "host/companion/window/scope/trigger.hpp"

#include <algorithm>

namespace inkwell::window {

std::optional<std::uint64_t> find_crossing(const SignalSeries& series, std::uint64_t first, std::uint64_t last,
                                           float level, TriggerEdge edge) {
  first = std::max(first, series.begin() + 1);
  last = std::min(last, series.end());
  for (std::uint64_t i = first; i < last; ++i) {
    const float before = series[i - 1];
    const float now = series[i];
    if (edge == TriggerEdge::rising ? before < level && now >= level : before > level && now <= level) return i;
  }
  return std::nullopt;
}

void Trigger::arm() {
  coming_.reset();
  event_.reset();
  next_checked_ = UINT64_MAX;
}

void Trigger::advance(const SignalSeries& series, const TriggerSettings& settings, double span) {
  if (settings.mode == TriggerMode::off) return;
  // After arm() or a restart of the history, the search starts with the next sample.
  if (next_checked_ > series.end()) next_checked_ = series.end();
  if (settings.mode == TriggerMode::single && event_) return;
  const auto after = static_cast<std::uint64_t>(span * (1.0 - static_cast<double>(settings.pre_trigger)));
  while (true) {
    if (coming_) {
      if (series.end() < *coming_ + after) return;
      event_ = coming_;
      next_checked_ = std::max(next_checked_, *coming_ + after);
      coming_.reset();
      if (settings.mode == TriggerMode::single) return;
    }
    coming_ = find_crossing(series, next_checked_, series.end(), settings.level, settings.edge);
    next_checked_ = series.end();
    if (!coming_) return;
    next_checked_ = *coming_ + 1;
  }
}

}  // namespace inkwell::window
