// Time range of the scope.
#pragma once

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

class Timeline {
 public:
  Timeline(double span_s, const TriggerSettings& trigger) : trigger_settings_(trigger), span_s_(span_s) {}

  /// Adds samples from the device or a recording. A paused timeline discards received samples. `over` contains the
  /// samples of the overlaid recording, or is null.
  void receive(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr);
  /// Sets the formulas that are computed in addition to the received signals.
  void derive(const std::vector<ScopeSignal>& formulas) { history_.derive(formulas); }
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

  const TriggerSettings& trigger() const { return trigger_settings_; }
  bool is_triggered() const { return trigger_settings_.mode != TriggerMode::off; }
  void set_trigger(const TriggerSettings& settings);
  void arm_trigger() { trigger_.arm(); }

 private:
  SignalHistory history_;
  Trigger trigger_;
  TriggerSettings trigger_settings_;
  double span_s_;
  bool paused_ = false;
  double paused_last_ = 0.0;  ///< right end of the displayed section while paused
};

}  // namespace inkwell::window
