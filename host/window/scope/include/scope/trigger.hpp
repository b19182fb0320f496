// The scope's trigger, which finds the event that a picture is aligned to.
#pragma once

#include <cstdint>
#include <optional>

#include <scope/signal_history.hpp>

namespace inkwell::window {

enum class TriggerEdge : std::uint8_t { rising, falling };
enum class TriggerMode : std::uint8_t {
  off,     ///< the newest samples scroll
  normal,  ///< each new event replaces the picture
  single,  ///< the first event remains until the trigger is armed again
};

struct TriggerSettings {
  TriggerMode mode = TriggerMode::off;
  protocol::Signal signal = protocol::Signal::force_N;
  TriggerEdge edge = TriggerEdge::rising;
  float level = 0.1f;
  float pre_trigger = 0.2f;  ///< part of the picture before the event, 0..1
  bool operator==(const TriggerSettings&) const = default;
};

/// Returns the first index in [first, last) at which the signal has crossed the level since the previous sample.
std::optional<std::uint64_t> find_crossing(const SignalSeries& series, std::uint64_t first, std::uint64_t last,
                                           float level, TriggerEdge edge);

/// Examines each new sample once.
class Trigger {
 public:
  void arm();  ///< clears the event
  /// Examines the new samples of the series; `span` is the length of the picture in samples.
  void advance(const SignalSeries& series, const TriggerSettings& settings, double span);
  /// Index of the event whose picture is complete, if any.
  std::optional<std::uint64_t> event() const { return event_; }

 private:
  std::uint64_t looked_at_ = 0;
  std::optional<std::uint64_t> coming_;  // event whose picture is not complete yet
  std::optional<std::uint64_t> event_;
};

}  // namespace inkwell::window
