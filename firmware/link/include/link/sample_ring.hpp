// The last control periods, whole: every signal, and where the board stood.
#pragma once

#include <array>
#include <cstdint>

#include <link/shared.hpp>
#include <protocol/signals.hpp>
#include <protocol/supervision.hpp>

namespace inkwell::link {

/// What one control period leaves behind beside its signals.
struct PeriodSummary {
  protocol::State state;
  protocol::Fault fault;
  std::uint8_t switches;       ///< bits of protocol::Switch
  std::uint8_t force_sources;  ///< bits of protocol::ForceSource
  std::uint8_t limits;         ///< bits of protocol::Limit
  bool is_referenced;          ///< it is known where the arm is
  std::uint8_t command_token;  ///< CommandQueue::last_token()
  std::uint32_t periods;       ///< number of this control period
  std::uint32_t begin_cycles;  ///< the cycle counter at its begin
};

struct Sample {
  protocol::SignalValues signals;
  PeriodSummary summary;
};

/// The interrupt writes each period straight into its place here, which is all that recording costs there. The main
/// loop follows: pose reports, scope and black box read from here, each at its own pace.
class SampleRing {
 public:
  /// Samples in the ring: 1.6 ms, against the fraction of one for which the main loop is busy at most.
  static constexpr std::uint32_t capacity = 32;
  /// Two places stay unread, for the samples that the interrupt may write while one is read.
  static constexpr std::uint32_t readable = capacity - 2;

  /// `first` is the number of the first sample.
  explicit SampleRing(std::uint32_t first = 0) : first_(first), recorded_(first) {}

  // ---- control interrupt ----

  /// Where this period goes; it counts once record() has been called.
  Sample& next() { return samples_[recorded_.load() % capacity]; }

  /// Records what was written to next(). Called once every control period.
  void record() { recorded_.store(recorded_.load() + 1); }

  // ---- main loop ----

  /// The number of the next sample: samples recorded since the start. Wraps.
  std::uint32_t recorded() const { return recorded_.load(); }

  /// Null before the first sample. The interrupt comes back to its place 1.6 ms later.
  const Sample* newest() const {
    const std::uint32_t recorded = recorded_.load();
    // Once it is set it stays, because the count comes back to the first number when it wraps.
    has_samples_ = has_samples_ || recorded != first_;
    return has_samples_ ? &samples_[(recorded - 1) % capacity] : nullptr;
  }

  /// One of the `readable` newest.
  const Sample& operator[](std::uint32_t number) const { return samples_[number % capacity]; }

 private:
  std::array<Sample, capacity> samples_{};
  std::uint32_t first_;
  Shared<std::uint32_t> recorded_;    ///< written by the interrupt
  mutable bool has_samples_ = false;  ///< known to the main loop
};

}  // namespace inkwell::link
