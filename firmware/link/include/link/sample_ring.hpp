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

  // ---- control interrupt ----

  /// Where this period goes; it counts once record() has been called.
  Sample& next() { return samples_[recorded_.load() % capacity]; }

  /// Records what was written to next(). Called once every control period.
  void record() { recorded_.store(recorded_.load() + 1); }

  // ---- main loop ----

  /// Samples recorded since the start; the newest has the number before.
  std::uint32_t recorded() const { return recorded_.load(); }

  /// One of the `readable` newest.
  const Sample& operator[](std::uint32_t number) const { return samples_[number % capacity]; }

 private:
  std::array<Sample, capacity> samples_{};
  Shared<std::uint32_t> recorded_{0};  ///< written by the interrupt
};

}  // namespace inkwell::link
