// Ranges and ticks of plot axes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace inkwell::window {

struct AxisRange {
  double minimum;
  double maximum;

  double extent() const { return maximum - minimum; }
  /// Maps the minimum to 0 and the maximum to 1.
  double part(double value) const { return (value - minimum) / extent(); }
};

/// Returns about `wanted` multiples of 1, 2 or 5 times a power of ten within the range.
std::vector<double> ticks(const AxisRange& range, int wanted);

/// Height of an axis around constant zero for a unit: a small amount for a haptic arm, e.g. 2 cm. Returns 2 for an
/// unknown unit.
double extent_around_zero(std::string_view unit);

/// Returns the smallest range between such multiples that contains the data with a margin. A constant gets a range of a
/// fifth of its value. Constant zero or missing data (NaN) gets `around_zero`.
AxisRange enclosing_range(double minimum, double maximum, double around_zero = 2.0);

/// Formats a tick value with enough digits to distinguish adjacent ticks, e.g. "0.25", "1500", "2e-06".
std::string tick_label(double value, double step);

/// Follows the data, but shrinks only after the data have been smaller for a while, so that the axis does not jitter.
/// The first change replaces the estimated range around a constant.
class SteadyRange {
 public:
  explicit SteadyRange(double around_zero = 2.0) : around_zero_(around_zero) {}
  AxisRange update(double minimum, double maximum, double now_s);

 private:
  double around_zero_;
  AxisRange range_{0.0, 0.0};
  bool is_guess_ = false;
  double small_since_s_ = 0.0;
};

}  // namespace inkwell::window
