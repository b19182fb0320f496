// Ranges and ticks of a plot's axes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace inkwell::window {

struct AxisRange {
  double minimum;
  double maximum;

  double extent() const { return maximum - minimum; }
  /// 0 at the minimum, 1 at the maximum.
  double part(double value) const { return (value - minimum) / extent(); }
};

/// Multiples of 1, 2 or 5 times a power of ten that lie in the range, about `wanted` of them.
std::vector<double> ticks(const AxisRange& range, int wanted);

/// What an axis shows around a plain zero: what a haptic arm has of such a unit when it does a little, e.g. 2 cm. 2 for
/// a unit that is not known.
double extent_around_zero(std::string_view unit);

/// The smallest range between such multiples that holds the data with a little room. Data that are constant get a
/// fifth of their value, a plain zero and data that are not there (NaN) `around_zero`.
AxisRange enclosing_range(double minimum, double maximum, double around_zero = 2.0);

/// A tick's number with as many digits as its neighbours need to differ, e.g. "0.25", "1500", "2e-06".
std::string tick_label(double value, double step);

/// Follows the data, but shrinks only after the data has been small for a while, so that axes do not tremble. The room
/// around a constant is a guess, which the first change replaces.
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
