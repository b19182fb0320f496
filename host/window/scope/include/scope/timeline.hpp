// Which stretch of the signals the scope shows: the newest, the one around an event, or one of the past.
#pragma once

#include <scope/scope_settings.hpp>
#include <scope/signal_history.hpp>
#include <scope/trigger.hpp>

namespace inkwell::window {

/// Part of the history, in samples; `zero` is where its axis says 0.
struct Stretch {
  double first;
  double last;
  double zero;

  double span() const { return last - first; }
  /// As indices of samples.
  std::uint64_t first_index() const { return first > 0.0 ? static_cast<std::uint64_t>(first) : 0; }
  std::uint64_t last_index() const { return last > 0.0 ? static_cast<std::uint64_t>(last) : 0; }
};

class Timeline {
 public:
  Timeline(double span_s, const TriggerSettings& trigger) : trigger_settings_(trigger), span_s_(span_s) {}

  /// Samples from the device; while paused they are let go, so that what is looked at stays.
  /// `over`: of the same periods, of a recording that is laid over; null if none is.
  void receive(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr);
  /// Formulas whose values are to be there beside what is received.
  void derive(const std::vector<ScopeSignal>& formulas) { history_.derive(formulas); }
  /// Forgets what was received: what comes next does not continue it.
  void start_anew();
  const SignalHistory& history() const { return history_; }

  /// What is to be shown now; finds the trigger's events.
  Stretch stretch();

  double span_s() const { return span_s_; }
  void set_span_s(double span_s) { span_s_ = span_s; }
  /// By steps of the mouse wheel, positive shows less. What lies at `right_part` of the span from its right end stays
  /// there while paused.
  void zoom(double steps, double right_part);

  bool is_paused() const { return paused_; }
  void pause(bool paused);
  /// Pauses and moves the stretch into the past by a part of the span, no farther than something is kept.
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
  double paused_last_ = 0.0;  ///< right end of what is shown while paused
};

}  // namespace inkwell::window
