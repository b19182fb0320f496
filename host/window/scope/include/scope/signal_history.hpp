// The last minutes of the scope's signals, kept so that any stretch of them can be drawn at once.
//
// Each signal has a ring of samples and, above it, rings of the smallest and largest value of 16, 256, 4096...
// samples. The extremes of any stretch then take a few dozen look-ups, however long it is, so a plot of
// millions of samples costs what its pixels cost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <device/device.hpp>
#include <protocol/signals.hpp>

namespace inkwell::window {

/// Smallest and largest value of a stretch; both NaN where every sample of it was lost.
struct Extremes {
  float minimum;
  float maximum;
};

class SignalSeries {
 public:
  explicit SignalSeries(std::size_t capacity);  ///< a power of 16 times a power of 2, at least 16

  void append(float value);

  std::uint64_t end() const { return end_; }  ///< index one past the newest sample, counted from the first ever
  std::uint64_t begin() const { return end_ > capacity_ ? end_ - capacity_ : 0; }
  float operator[](std::uint64_t index) const { return samples_[index & (capacity_ - 1)]; }

  /// Over [first, last), cut to what is kept.
  Extremes extremes(std::uint64_t first, std::uint64_t last) const;

 private:
  struct Level {
    std::unique_ptr<Extremes[]> blocks;
    std::size_t mask;
  };
  std::size_t capacity_;
  std::uint64_t end_ = 0;
  std::unique_ptr<float[]> samples_;
  std::vector<Level> levels_;  // levels_[k]: blocks of 16^(k+1) samples
};

/// The signals that are streamed now. Index 0 is the first control period received since the selection.
class SignalHistory {
 public:
  explicit SignalHistory(std::size_t capacity = std::size_t{1} << 21) : capacity_(capacity) {}

  /// Another choice of signals in `samples` starts the history anew. Lost samples become NaN, so a gap is seen.
  void append(const device::ScopeSamples& samples);
  void clear();

  std::uint64_t begin() const { return series_.empty() ? 0 : series_.front().begin(); }
  std::uint64_t end() const { return series_.empty() ? 0 : series_.front().end(); }
  const SignalSeries* find(protocol::Signal signal) const;

 private:
  std::size_t capacity_;
  std::vector<protocol::Signal> signals_;
  std::vector<SignalSeries> series_;
};

/// One pair for each of `columns` equal parts of [first, last), for drawing.
std::vector<Extremes> decimate(const SignalSeries& series, double first, double last, std::size_t columns);

}  // namespace inkwell::window
