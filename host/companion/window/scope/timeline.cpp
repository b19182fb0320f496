#include "host/companion/window/scope/timeline.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/reports.hpp"

namespace inkwell::window {

namespace {

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr double zoom_per_step = 0.15;
constexpr double parts_of_span = 2048.0;  // the right end moves in whole multiples of span / parts_of_span

}  // namespace

void Timeline::receive(const device::ScopeSamples& samples, const device::ScopeSamples* over) {
  if (!paused_) history_.append(samples, over);
}

void Timeline::restart() {
  history_.clear();
  trigger_.arm();
  paused_ = false;
}

void Timeline::pause(bool paused) {
  if (paused == paused_) return;
  if (paused) {
    paused_last_ = stretch().last;
  } else {
    restart();  // the samples during the pause were discarded
  }
  paused_ = paused;
}

void Timeline::set_trigger(const TriggerSettings& settings) {
  TriggerSettings same_position = settings;
  same_position.pre_trigger = trigger_settings_.pre_trigger;  // a change of pre_trigger does not need a new event
  if (same_position != trigger_settings_) trigger_.arm();
  trigger_settings_ = settings;
}

Stretch Timeline::stretch() {
  const double span = span_s_ * rate_Hz;
  const auto end = static_cast<double>(history_.end());
  if (paused_) return {paused_last_ - span, paused_last_, end};
  if (is_triggered()) {
    if (const SignalSeries* series = history_.find(trigger_settings_.signal))
      trigger_.advance(*series, trigger_settings_, span);
    if (const auto event = trigger_.event()) {
      const double first = static_cast<double>(*event) - static_cast<double>(trigger_settings_.pre_trigger) * span;
      return {first, first + span, static_cast<double>(*event)};
    }
  }
  // The section moves in whole steps, so that scrolling lines do not flicker.
  const double part = std::max(1.0, std::floor(span / parts_of_span));
  const double last = std::floor(end / part) * part;
  return {last - span, last, last};
}

void Timeline::zoom(double steps, double right_part) {
  const double before_s = span_s_;
  span_s_ = std::clamp(span_s_ * std::exp(-zoom_per_step * steps), ScopeSettings::span_minimum_s,
                       ScopeSettings::span_maximum_s);
  if (paused_) paused_last_ += right_part * (span_s_ - before_s) * rate_Hz;
}

void Timeline::drag(double part) {
  pause(true);
  const double span = span_s_ * rate_Hz;
  const auto begin = static_cast<double>(history_.begin());
  const auto end = static_cast<double>(history_.end());
  paused_last_ = std::clamp(paused_last_ - part * span, begin, std::max(begin, end + 0.5 * span));
}

}  // namespace inkwell::window
