// Mean and extremes of many samples.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

namespace inkwell::recording {

/// Many samples in one point of a figure. The line shows the mean, and the band shows the smallest and the largest
/// value.
struct Band {
  double mean, minimum, maximum;
};

/// Joins the bands of several parts. Extremes ignore NaN.
class BandSum {
 public:
  void add(double value) {
    sum_ += value;
    widen(value, value);
    ++count_;
  }
  void add(const Band& part, std::size_t samples) {
    sum_ += part.mean * static_cast<double>(samples);
    widen(part.minimum, part.maximum);
    count_ += samples;
  }
  /// Without values all members are NaN, which leaves a gap in the figure.
  Band band() const { return {sum_ / static_cast<double>(count_), minimum_, maximum_}; }

 private:
  void widen(double minimum, double maximum) {
    if (minimum < minimum_ || std::isnan(minimum_)) minimum_ = minimum;
    if (maximum > maximum_ || std::isnan(maximum_)) maximum_ = maximum;
  }

  double sum_ = 0;
  double minimum_ = std::numeric_limits<double>::quiet_NaN(), maximum_ = minimum_;
  std::size_t count_ = 0;
};

/// Returns the band of value_at(0) to value_at(count - 1).
template <class ValueAt>
Band band_of(std::size_t count, ValueAt value_at) {
  BandSum sum;
  for (std::size_t i = 0; i < count; ++i) sum.add(value_at(i));
  return sum.band();
}

}  // namespace inkwell::recording
