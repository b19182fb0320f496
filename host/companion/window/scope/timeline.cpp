#include "host/companion/window/scope/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/reports.hpp"

namespace inkwell::window {

namespace {

constexpr double rate_Hz = protocol::servo_rate_Hz;
constexpr double zoom_per_step = 0.15;
constexpr double after_fault_part = 0.25;  // of the displayed time
constexpr double after_fault_maximum_s = 1.0;
constexpr double parts_of_span = 2048.0;  // the right end moves in whole multiples of span / parts_of_span

}  // namespace

void Timeline::receive(const device::ScopeSamples& samples, const device::ScopeSamples* over) {
  if (paused_ && would_overwrite(samples)) {
    discarded_ += samples.lost_before + samples.count;
    return;
  }
  if (discarded_ == 0) return history_.append(samples, over);
  device::ScopeSamples after_gap = samples;
  after_gap.lost_before += std::exchange(discarded_, 0);
  history_.append(after_gap, over);
}

void Timeline::refill(const std::vector<ReceivedBlock>& blocks) {
  if (blocks.empty()) return;
  history_.clear(history_.index_of(blocks.front().samples.first_period).value_or(0));
  for (const ReceivedBlock& block : blocks) history_.append(block.samples, block.over ? &*block.over : nullptr);
}

bool Timeline::would_overwrite(const device::ScopeSamples& samples) const {
  const double end = static_cast<double>(history_.end() + samples.lost_before + samples.count);
  return end - static_cast<double>(history_.capacity()) > std::max(0.0, paused_last_ - span_s_ * rate_Hz);
}

double Timeline::after_fault() const { return std::min(after_fault_part * span_s_, after_fault_maximum_s) * rate_Hz; }

void Timeline::freeze_at(std::int64_t fault_period) {
  fault_ = history_.index_of(fault_period);
  waits_for_fault_ = fault_.has_value() && !paused_;
}

void Timeline::show_fault() {
  if (!fault_ || *fault_ < history_.begin()) return;
  paused_ = true;
  frozen_ = true;
  waits_for_fault_ = false;
  paused_last_ = static_cast<double>(*fault_) + after_fault();
}

void Timeline::restart() {
  history_.clear();
  trigger_.arm();
  paused_ = false;
  discarded_ = 0;
  fault_.reset();
  waits_for_fault_ = false;
  frozen_ = false;
}

void Timeline::pause(bool paused) {
  if (paused == paused_) return;
  if (paused) {
    const Stretch shown = stretch();
    paused_last_ = shown.last;
    paused_zero_ = shown.zero;
  }
  paused_ = paused;
  frozen_ = false;
  waits_for_fault_ = false;
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
  if (waits_for_fault_ && end >= static_cast<double>(*fault_) + after_fault()) show_fault();
  if (paused_) return {paused_last_ - span, paused_last_, frozen_ ? static_cast<double>(*fault_) : paused_zero_};
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
