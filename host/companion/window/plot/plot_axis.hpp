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

/// Returns about `wanted` ticks within the range. The distance between ticks is 1, 2 or 5 times a power of ten.
std::vector<double> ticks(const AxisRange& range, int wanted);

/// Returns the axis extent for a constant zero signal, such as 0.02 for the unit "m". Returns 2 for an unknown unit.
double extent_around_zero(std::string_view unit);

/// Returns the smallest range with round bounds that contains the data and a margin. For a constant signal, the extent
/// is about a fifth of the value. For a constant zero signal or missing data (NaN), the extent is `around_zero`.
AxisRange enclosing_range(double minimum, double maximum, double around_zero = 2.0);

/// Formats a tick value with enough digits to distinguish adjacent ticks, such as "0.25", "1500", "2e-06".
std::string tick_label(double value, double step);

/// Axis range. The range grows immediately and shrinks after a delay, so that the axis does not jitter. When a constant
/// signal first changes, the measured range replaces the estimated range.
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
