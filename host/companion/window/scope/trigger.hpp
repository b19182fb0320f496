// The scope's trigger. Finds the event at which the plots are aligned.
#pragma once

#include <cstdint>
#include <optional>

#include "host/companion/window/scope/signal_history.hpp"

namespace inkwell::window {

enum class TriggerEdge : std::uint8_t { rising, falling };
enum class TriggerMode : std::uint8_t {
  off,     ///< the newest samples scroll
  normal,  ///< each new event replaces the previous event
  single,  ///< the first event remains until the trigger is armed again
};

struct TriggerSettings {
  TriggerMode mode = TriggerMode::off;
  protocol::Signal signal = protocol::Signal::force_N;
  TriggerEdge edge = TriggerEdge::rising;
  float level = 0.1f;
  float pre_trigger = 0.2f;  ///< fraction of the span before the event, 0 to 1
  bool operator==(const TriggerSettings&) const = default;
};

/// Returns the index of the first sample in [first, last) after a level crossing.
std::optional<std::uint64_t> find_crossing(const SignalSeries& series, std::uint64_t first, std::uint64_t last,
                                           float level, TriggerEdge edge);

/// Examines each new sample once.
class Trigger {
 public:
  void arm();  ///< clears the event
  /// Examines the new samples of the series. `span` is the displayed number of samples.
  void advance(const SignalSeries& series, const TriggerSettings& settings, double span);
  /// Returns the index of the last event with a complete span; empty if there is no event.
  std::optional<std::uint64_t> event() const { return event_; }

 private:
  std::uint64_t next_checked_ = 0;
  std::optional<std::uint64_t> coming_;  // event with an incomplete span
  std::optional<std::uint64_t> event_;
};

}  // namespace inkwell::window
