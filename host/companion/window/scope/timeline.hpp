// Time range of the scope.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/companion/window/scope/scope_settings.hpp"
#include "host/companion/window/scope/signal_history.hpp"
#include "host/companion/window/scope/trigger.hpp"

namespace inkwell::window {

/// Section of the history, in samples. `zero` is the origin of the time axis.
struct Stretch {
  double first;
  double last;
  double zero;

  double span() const { return last - first; }
  /// Returns the index of the first sample.
  std::uint64_t first_index() const { return first > 0.0 ? static_cast<std::uint64_t>(first) : 0; }
  std::uint64_t last_index() const { return last > 0.0 ? static_cast<std::uint64_t>(last) : 0; }
};

/// Samples of a recording, and the samples of the overlaid recording.
struct ReceivedBlock {
  device::ScopeSamples samples;
  std::optional<device::ScopeSamples> over;
};

class Timeline {
 public:
  Timeline(double span_s, const TriggerSettings& trigger) : trigger_settings_(trigger), span_s_(span_s) {}

  /// Adds samples from the device or a recording. While paused, discards samples only if the displayed section would be
  /// overwritten. `over` contains the samples of the overlaid recording, or is null.
  void receive(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr);
  /// Sets the formulas that are computed in addition to the received signals.
  void derive(const std::vector<ScopeSignal>& formulas) { history_.derive(formulas); }
  /// Replaces the history by other signals of the same time. The displayed section does not move.
  void refill(const std::vector<ReceivedBlock>& blocks);
  /// Clears the history. Call if the next samples do not directly follow the previous samples.
  void restart();
  const SignalHistory& history() const { return history_; }

  /// Searches for trigger events and returns the displayed section.
  Stretch stretch();

  double span_s() const { return span_s_; }
  void set_span_s(double span_s) { span_s_ = span_s; }
  /// Zooms by steps of the mouse wheel. Positive steps reduce the span. While the timeline is paused, the sample at the
  /// mouse position does not move. `right_part` is the distance of the mouse from the right end, as a fraction of the
  /// span.
  void zoom(double steps, double right_part);

  bool is_paused() const { return paused_; }
  void pause(bool paused);
  /// Pauses the timeline and moves the displayed section by a fraction of the span. A positive fraction moves the
  /// section into the past.
  void drag(double part);

  /// Pauses shortly after the control period of a fault. The origin of the time axis is then the fault.
  void freeze_at(std::int64_t fault_period);
  /// Pauses the timeline and moves the displayed section to the last fault, if the history contains the fault.
  void show_fault();
  /// Returns true while the timeline is paused at a fault.
  bool is_frozen_at_fault() const { return paused_ && frozen_; }
  /// Returns the index of the last fault; empty without a fault in the history.
  std::optional<std::uint64_t> fault() const { return fault_; }

  const TriggerSettings& trigger() const { return trigger_settings_; }
  bool is_triggered() const { return trigger_settings_.mode != TriggerMode::off; }
  void set_trigger(const TriggerSettings& settings);
  void arm_trigger() { trigger_.arm(); }

 private:
  /// Returns the displayed time after the fault, in samples.
  double after_fault() const;
  bool would_overwrite(const device::ScopeSamples& samples) const;

  SignalHistory history_;
  Trigger trigger_;
  TriggerSettings trigger_settings_;
  double span_s_;
  bool paused_ = false;
  double paused_last_ = 0.0;            ///< right end of the displayed section while paused
  double paused_zero_ = 0.0;            ///< origin of the time axis while paused
  std::uint64_t discarded_ = 0;         ///< number of discarded samples since the last stored sample
  std::optional<std::uint64_t> fault_;  ///< index of the last fault
  bool waits_for_fault_ = false;        ///< the timeline will pause after the samples of the fault
  bool frozen_ = false;                 ///< paused because of a fault
};

}  // namespace inkwell::window
