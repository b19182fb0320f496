// Sends one test pulse and keeps what the scope shows of it.
#pragma once

#include <string>
#include <vector>

#include <guides/step.hpp>
#include <recording/recording.hpp>

namespace inkwell::guides {

class PulseRecorder {
 public:
  /// `seen_in`: the signal that differs from zero while the pulse is on. It is among `signals`.
  PulseRecorder(protocol::Command command, const protocol::TestPulse& pulse, std::vector<protocol::Signal> signals,
                protocol::Signal seen_in);

  void begin(const device::Pose& pose, DevicePort& port);
  void receive(const device::ScopeSamples& samples);
  /// True once the pulse and the rest after it are recorded without a gap. A recording with a gap is made again, three
  /// times at most. Throws device::Error if the scope or the pulse does not come.
  bool advance(const device::Pose& pose, DevicePort& port);

  const std::vector<float>& column(protocol::Signal signal) const { return recording_.column(signal); }
  std::vector<double> values_of(protocol::Signal signal) const;
  std::size_t size() const { return recording_.size(); }

 private:
  enum class State : std::uint8_t { waits_for_scope, waits_for_end, done };
  void start_over(const device::Pose& pose);
  bool is_at_rest() const;
  std::size_t samples_of_pulse() const;

  protocol::Command command_;
  protocol::TestPulse pulse_;
  protocol::Signal seen_in_;
  recording::Recording recording_;
  State state_ = State::waits_for_scope;
  std::size_t rest_samples_;  ///< that have to show zero before a pulse is sent
  Stopwatch since_;
  int attempts_left_ = 3;
};

}  // namespace inkwell::guides
