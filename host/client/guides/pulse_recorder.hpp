// Sends one test pulse and records it with the scope.
#pragma once

#include <string>
#include <vector>

#include "host/client/guides/step.hpp"
#include "host/client/recording/recording.hpp"

namespace inkwell::guides {

class PulseRecorder {
 public:
  /// `seen_in` is the signal that is nonzero during the pulse. `signals` must contain this signal.
  PulseRecorder(protocol::Command command, const protocol::TestPulse& pulse, std::vector<protocol::Signal> signals,
                protocol::Signal seen_in);

  void begin(const device::Pose& pose, DevicePort& port);
  void receive(const device::ScopeSamples& samples);
  /// Returns true once the pulse and the rest period after the pulse are recorded without a gap. A recording with a gap
  /// is repeated, at most three times. Throws device::Error if the scope or the pulse does not start.
  bool advance(const device::Pose& pose, DevicePort& port);

  const std::vector<float>& column(protocol::Signal signal) const { return recording_.column(signal); }
  std::vector<double> values_of(protocol::Signal signal) const;
  std::size_t size() const { return recording_.size(); }
  const recording::Recording& recording() const { return recording_; }

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
  std::size_t rest_samples_;  ///< required zero samples before a pulse
  Stopwatch since_;
  int attempts_left_ = 3;
};

}  // namespace inkwell::guides
