#include "host/client/guides/pulse_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace inkwell::guides {
namespace {

constexpr std::size_t samples_before = 40;  // zero samples before the pulse
constexpr double scope_limit_s = 2.0, pulse_limit_s = 1.0;

}  // namespace

PulseRecorder::PulseRecorder(protocol::Command command, const protocol::TestPulse& pulse,
                             std::vector<protocol::Signal> signals, protocol::Signal seen_in)
    : command_(command), pulse_(pulse), seen_in_(seen_in), rest_samples_(samples_before) {
  recording::Information information;
  information.signals = std::move(signals);
  recording_ = recording::Recording::without_samples(std::move(information));
}

void PulseRecorder::begin(const device::Pose& pose, DevicePort& port) {
  port.select_signals(recording_.information.signals);
  start_over(pose);
}

void PulseRecorder::start_over(const device::Pose& pose) {
  recording_.keep(0, 0);
  state_ = State::waits_for_scope;
  since_.start(pose);
}

void PulseRecorder::receive(const device::ScopeSamples& samples) {
  if (samples.signals == recording_.information.signals && state_ != State::done) recording_.append(samples);
}

bool PulseRecorder::advance(const device::Pose& pose, DevicePort& port) {
  if (state_ == State::done) return true;
  if (pose.state != protocol::State::ready)
    throw device::Error(
        "Test pulses need the state ready. Put the stylus into the inkwell once, leave the force off "
        "and start the guide again.");
  if (recording_.lost() > 0) {
    if (--attempts_left_ == 0)
      throw device::Error(
          "Samples of the scope were lost repeatedly. Close other programs that load this computer and start the guide "
          "again.");
    rest_samples_ = std::max(samples_before, samples_of_pulse());
    start_over(pose);
  }
  if (state_ == State::waits_for_scope) {
    if (since_.seconds(pose) > scope_limit_s)
      throw device::Error("The scope sends nothing. Reset the board and start the guide again.");
    if (!is_at_rest()) return false;
    recording_.keep(recording_.size() - samples_before, recording_.size());
    port.send(command_, pulse_);
    since_.start(pose);
    state_ = State::waits_for_end;
  }
  const auto& seen = recording_.column(seen_in_);
  const auto begin =
      static_cast<std::size_t>(std::ranges::find_if(seen, [](float value) { return value != 0.0f; }) - seen.begin());
  const std::size_t needed = 2 * samples_of_pulse();
  if (recording_.size() < begin + needed || begin == recording_.size()) {
    if (since_.seconds(pose) > pulse_limit_s + 2.0 * static_cast<double>(pulse_.duration_s))
      throw device::Error(
          "The test pulse did not start. Check that no other program sends commands to the device, reset the board and "
          "start the guide again.");
    return false;
  }
  // The recording starts shortly before the pulse and stops after the rest period.
  const std::size_t from = begin > samples_before ? begin - samples_before : 0;
  recording_.keep(from, begin + needed);
  state_ = State::done;
  return true;
}

std::size_t PulseRecorder::samples_of_pulse() const {
  return static_cast<std::size_t>(std::lround(pulse_.duration_s * protocol::servo_rate_Hz));
}

// The board refuses pulses during a pulse and during the rest period after the pulse. A repeated recording may start
// during a pulse or a rest period.
bool PulseRecorder::is_at_rest() const {
  const auto& seen = recording_.column(seen_in_);
  if (seen.size() < rest_samples_) return false;
  return std::all_of(seen.end() - static_cast<std::ptrdiff_t>(rest_samples_), seen.end(),
                     [](float value) { return value == 0.0f; });
}

std::vector<double> PulseRecorder::values_of(protocol::Signal signal) const {
  const auto& column = recording_.column(signal);
  return {column.begin(), column.end()};
}

}  // namespace inkwell::guides
