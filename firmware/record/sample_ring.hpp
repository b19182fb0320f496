// Samples of the last control periods: all signals and the state of the board.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/exchange/shared.hpp"
#include "protocol/signals.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::link {

/// State of the board in one control period.
struct PeriodSummary {
  protocol::State state;
  protocol::Fault fault;
  std::uint8_t switches;       ///< bits of protocol::Switch
  std::uint8_t force_sources;  ///< bits of protocol::ForceSource
  std::uint8_t limits;         ///< bits of protocol::Limit
  bool is_referenced;          ///< the position of the arm is known
  std::uint8_t command_token;  ///< CommandQueue::last_token()
  std::uint32_t periods;       ///< number of this control period
  std::uint32_t begin_cycles;  ///< cycle counter at the start of this control period
};

struct Sample {
  protocol::SignalValues signals;
  PeriodSummary summary;
};

/// The interrupt writes each sample directly into the ring, without a copy. The main loop creates pose reports, scope
/// frames and black-box rows from the ring.
class SampleRing {
 public:
  /// Number of samples for 1.6 ms. A pass of the main loop takes less than 1 ms.
  static constexpr std::uint32_t capacity = 32;
  /// Two slots are never read, because the interrupt may write two samples while the main loop reads one sample.
  static constexpr std::uint32_t readable = capacity - 2;

  /// `first` is the number of the first sample.
  explicit SampleRing(std::uint32_t first = 0) : first_(first), recorded_(first) {}

  // ---- control interrupt ----

  /// Returns the slot for the sample of this period. The interrupt fills the slot and then calls record().
  Sample& next() { return samples_[recorded_.load() % capacity]; }

  /// Makes the sample of this period visible to the main loop.
  void record() { recorded_.store(recorded_.load() + 1); }

  // ---- main loop ----

  /// Number of the next sample. Sample numbers are counted from start-up and wrap.
  std::uint32_t recorded() const { return recorded_.load(); }

  /// Returns the newest sample, or null before the first sample. The interrupt overwrites a sample after 1.6 ms.
  const Sample* newest() const {
    const std::uint32_t recorded = recorded_.load();
    // The flag `has_samples_` is not reset, because a wrapped sample number may be equal to `first_`.
    has_samples_ = has_samples_ || recorded != first_;
    return has_samples_ ? &samples_[(recorded - 1) % capacity] : nullptr;
  }

  /// Returns one of the `readable` newest samples.
  const Sample& operator[](std::uint32_t number) const { return samples_[number % capacity]; }

 private:
  std::array<Sample, capacity> samples_{};
  std::uint32_t first_;
  Shared<std::uint32_t> recorded_;    ///< written by the interrupt
  mutable bool has_samples_ = false;  ///< main loop only
};

}  // namespace inkwell::link
