// Ranges and ticks of a plot's axes.
#pragma once

#include <string>
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

/// The smallest range between such multiples that holds the data with a little room; one of its own for data that
/// is constant or not there (NaN).
AxisRange enclosing_range(double minimum, double maximum);

/// A tick's number with as many digits as its neighbours need to differ, e.g. "0.25", "1500", "2e-06".
std::string tick_label(double value, double step);

/// Follows the data, but shrinks only after the data has been small for a while, so that axes do not tremble. The room
/// around a constant is a guess, which the first change replaces.
class SteadyRange {
 public:
  AxisRange update(double minimum, double maximum, double now_s);

 private:
  AxisRange range_{0.0, 0.0};
  bool is_guess_ = false;
  double small_since_s_ = 0.0;
};

}  // namespace inkwell::window
