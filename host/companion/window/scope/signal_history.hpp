// Stores the last minutes of the scope's signals for fast drawing. Each signal has a ring buffer of samples. Additional
// ring buffers contain the minimum and maximum of each block of samples. The block sizes are powers of 16. The drawing
// time of a plot depends on the number of pixels, not on the number of samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/client/device/device.hpp"
#include "host/companion/window/scope/scope_signal.hpp"
#include "protocol/signals.hpp"

namespace inkwell::window {

/// Minimum and maximum of several samples, or NaN if all samples were lost.
struct Extremes {
  float minimum;
  float maximum;
};

class SignalSeries {
 public:
  /// `capacity` must be at least 16. `first` is the index of the first appended sample.
  explicit SignalSeries(std::size_t capacity, std::uint64_t first = 0);

  void append(float value);
  /// Returns a copy of the newest samples.
  SignalSeries with_capacity(std::size_t capacity) const;

  std::uint64_t end() const { return end_; }  ///< index of the next sample
  std::uint64_t begin() const { return std::max(first_, end_ > capacity_ ? end_ - capacity_ : 0); }
  /// Returns NaN for a sample before the first appended sample.
  float operator[](std::uint64_t index) const {
    return index < first_ ? std::numeric_limits<float>::quiet_NaN() : samples_[position_of(index)];
  }

  /// Returns the extremes of the stored samples in [first, last).
  Extremes extremes(std::uint64_t first, std::uint64_t last) const;

 private:
  struct Level {
    std::unique_ptr<Extremes[]> blocks;
    std::size_t count;  ///< of the blocks in the ring buffer
  };
  /// Position of a stored sample in the ring buffer, without a slow division.
  std::size_t position_of(std::uint64_t index) const { return index - lap_ + (index < lap_ ? capacity_ : 0); }

  std::size_t capacity_;
  std::uint64_t first_;
  std::uint64_t end_;
  std::uint64_t lap_;  ///< index of the newest sample at the start of the ring buffer
  std::unique_ptr<float[]> samples_;
  std::vector<Level> levels_;  // levels_[k]: blocks of 16^(k+1) samples
};

/// Samples from the device or from a recording.
class SignalLane {
 public:
  explicit SignalLane(std::size_t capacity) : capacity_(capacity) {}

  const std::vector<protocol::Signal>& signals() const { return signals_; }
  /// Number of signals and formulas.
  std::size_t width() const { return series_.size() + derived_.size(); }
  /// Retains the newest samples.
  void set_capacity(std::size_t capacity);
  /// Clears the samples and sets new signals. The next sample has the index `first`.
  void restart(std::vector<protocol::Signal> signals, std::uint64_t first);
  /// Sets new signals and retains the samples of the signals that are in both sets. The other signals start with the
  /// next sample.
  void select(const std::vector<protocol::Signal>& signals);
  /// Sets the formulas and computes their results for the stored samples.
  void derive(const std::vector<ScopeSignal>& formulas);
  /// Appends samples. `values` contains the values of all signals, period by period.
  void append(std::span<const float> values);
  void append_lost(std::uint64_t count);

  std::uint64_t begin() const;
  std::uint64_t end() const { return series_.empty() ? 0 : series_.front().end(); }
  const SignalSeries* find(const ScopeSignal& signal) const;

 private:
  struct Derived {
    ScopeSignal signal;
    FormulaValues values;
    std::vector<std::size_t> inputs;  ///< indices of the formula's inputs in signals_
    SignalSeries series;
  };

  std::optional<Derived> derived_of(const ScopeSignal& formula) const;
  void advance(Derived& derived, std::uint64_t until);

  std::size_t capacity_;
  std::vector<protocol::Signal> signals_;
  std::vector<SignalSeries> series_;
  std::vector<ScopeSignal> formulas_;
  std::vector<Derived> derived_;  ///< formulas with known inputs
  std::vector<float> inputs_;     ///< buffer for the inputs of a formula
};

/// History of the streamed signals and of an overlaid recording. Index 0 is the first received control period. The
/// history of many signals is shorter, so that the memory is limited.
class SignalHistory {
 public:
  static constexpr std::size_t memory_maximum_bytes = 80 << 20;

  explicit SignalHistory(std::size_t capacity_maximum = std::size_t{1} << 21)
      : capacity_maximum_(capacity_maximum), capacity_(capacity_maximum), shown_(capacity_), over_(capacity_) {}

  /// Appends samples. If the signals have changed, retains the samples of the signals that are still selected. Stores
  /// lost samples as NaN. Clears the history if the board has restarted or if too many samples were lost. `over`
  /// contains the samples of the overlaid recording, or is null.
  void append(const device::ScopeSamples& samples, const device::ScopeSamples* over = nullptr);
  /// Deletes all samples. The next sample has the index `first`.
  void clear(std::uint64_t first = 0);
  /// Sets the formulas that are computed in addition to the signals.
  void derive(const std::vector<ScopeSignal>& formulas);

  /// Returns the index of a control period, which need not be in the history; empty before the first sample.
  std::optional<std::uint64_t> index_of(std::int64_t period) const;
  /// Control period after the newest sample.
  std::int64_t next_period() const { return next_period_; }
  std::size_t capacity() const { return capacity_; }
  std::uint64_t begin() const { return shown_.begin(); }
  std::uint64_t end() const { return shown_.end(); }
  const SignalSeries* find(const ScopeSignal& signal) const { return shown_.find(signal); }
  const SignalSeries* find_over(const ScopeSignal& signal) const { return over_.find(signal); }

 private:
  /// Returns the number of lost samples before `samples`, or an empty optional if the history must be cleared.
  std::optional<std::uint64_t> gap_before(const device::ScopeSamples& samples) const;

  /// Adapts the capacity to the number of signals.
  void limit_memory();

  std::size_t capacity_maximum_, capacity_;
  SignalLane shown_, over_;
  std::uint64_t first_ = 0;       ///< index of the next sample after clear()
  std::int64_t next_period_ = 0;  ///< control period after the newest sample
};

/// Divides [first, last) into `columns` columns and returns the extremes of each column. The column widths are nearly
/// equal. Each sample belongs to exactly one column.
std::vector<Extremes> decimate(const SignalSeries& series, double first, double last, std::size_t columns);

}  // namespace inkwell::window
