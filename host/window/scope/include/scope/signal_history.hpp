// The last minutes of the scope's signals, kept so that any stretch of them can be drawn at once.
//
// Each signal has a ring of samples and, above it, rings of the smallest and largest value of 16, 256, 4096...
// samples. The extremes of any stretch then take a few dozen look-ups, however long it is, so a plot of
// millions of samples costs what its pixels cost.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <device/device.hpp>
#include <protocol/signals.hpp>
#include <scope/scope_signal.hpp>

namespace inkwell::window {

/// Smallest and largest value of a stretch; both NaN where every sample of it was lost.
struct Extremes {
  float minimum;
  float maximum;
};

class SignalSeries {
 public:
  /// `capacity`: a power of 16 times a power of 2, at least 16. `first`: index of the sample that is appended first.
  explicit SignalSeries(std::size_t capacity, std::uint64_t first = 0);

  void append(float value);

  std::uint64_t end() const { return end_; }  ///< index one past the newest sample, counted from the first ever
  std::uint64_t begin() const { return std::max(first_, end_ > capacity_ ? end_ - capacity_ : 0); }
  float operator[](std::uint64_t index) const { return samples_[index & (capacity_ - 1)]; }

  /// Over [first, last), cut to what is kept.
  Extremes extremes(std::uint64_t first, std::uint64_t last) const;

 private:
  struct Level {
    std::unique_ptr<Extremes[]> blocks;
    std::size_t mask;
  };
  std::size_t capacity_;
  std::uint64_t first_;
  std::uint64_t end_;
  std::unique_ptr<float[]> samples_;
  std::vector<Level> levels_;  // levels_[k]: blocks of 16^(k+1) samples
};

/// What came from one source: the device, or a recording.
class SignalLane {
 public:
  explicit SignalLane(std::size_t capacity) : capacity_(capacity) {}

  const std::vector<protocol::Signal>& signals() const { return signals_; }
  /// Begins anew with other signals; the first sample gets the index `first`.
  void begin_anew(std::vector<protocol::Signal> signals, std::uint64_t first);
  /// What formulas give, also of the samples that are there already.
  void derive(const std::vector<ScopeSignal>& formulas);
  /// Values of signals(), period by period.
  void append(std::span<const float> values);
  void append_lost(std::uint64_t count);

  std::uint64_t begin() const { return series_.empty() ? 0 : series_.front().begin(); }
  std::uint64_t end() const { return series_.empty() ? 0 : series_.front().end(); }
  const SignalSeries* find(const ScopeSignal& signal) const;

 private:
  struct Derived {
    ScopeSignal signal;
    FormulaValues values;
    std::vector<std::size_t> inputs;  ///< places of the formula's inputs in signals_
    SignalSeries series;
  };

  std::optional<Derived> derived_of(const ScopeSignal& formula) const;
  void advance(Derived& derived, std::uint64_t until);

  std::size_t capacity_;
  std::vector<protocol::Signal> signals_;
  std::vector<SignalSeries> series_;
  std::vector<ScopeSignal> formulas_;
  std::vector<Derived> derived_;  ///< of the formulas all of whose inputs are among the signals
  std::vector<float> inputs_;     ///< of one formula at one period, kept for the next one
};

/// The signals that are streamed now, and beside them those of a recording that is laid over. Index 0 is the first
/// control period received since the selection.
class SignalHistory {
 public:
  explicit SignalHistory(std::size_t capacity = std::size_t{1} << 21)
      : capacity_(capacity), shown_(capacity), over_(capacity) {}

  /// Another choice of signals in `samples` starts the history anew. Lost samples become NaN, so a gap is seen.
  /// `over`: of the same periods, what is laid over; null if nothing is.
  void append(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr);
  void clear();
  /// The formulas whose values are to be there, too.
  void derive(const std::vector<ScopeSignal>& formulas);

  std::uint64_t begin() const { return shown_.begin(); }
  std::uint64_t end() const { return shown_.end(); }
  const SignalSeries* find(const ScopeSignal& signal) const { return shown_.find(signal); }
  const SignalSeries* find_over(const ScopeSignal& signal) const { return over_.find(signal); }

 private:
  std::size_t capacity_;
  SignalLane shown_, over_;
};

/// One pair for each of `columns` parts of [first, last), for drawing: of equal width, but for a sixteenth of it. Every
/// sample is in one of them.
std::vector<Extremes> decimate(const SignalSeries& series, double first, double last, std::size_t columns);

}  // namespace inkwell::window
