// Range, drag scale and text format of a number.
#pragma once

#include <string>

namespace inkwell::window {

struct ValueRange {
  float minimum;
  float maximum;
  int decimals;              ///< number of decimals of the displayed and of the dragged value
  bool logarithmic = false;  ///< equal drag distances change the value by equal ratios; requires minimum > 0

  bool contains(float value) const { return value >= minimum && value <= maximum; }
  /// Returns the position in the range: 0 at the minimum, 1 at the maximum.
  float part_of(float value) const;
  /// Returns the value after a drag by `points`. A drag by 1000 points covers the whole range.
  float dragged(float from, float points) const;
  std::string text_of(float value) const;
};

}  // namespace inkwell::window
