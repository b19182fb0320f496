// The range of a number that is dragged or typed, its drag scale, and its text format.
#pragma once

#include <string>

namespace inkwell::window {

struct ValueRange {
  float minimum;
  float maximum;
  int decimals;              ///< decimal places of the shown value, to which a drag also rounds
  bool logarithmic = false;  ///< equal drag distances are equal ratios; needs minimum > 0

  bool contains(float value) const { return value >= minimum && value <= maximum; }
  /// Position in the range: 0 at the minimum, 1 at the maximum.
  float part_of(float value) const;
  /// The value after a drag over this number of screen points. A thousand points cover the whole range.
  float dragged(float from, float points) const;
  std::string text_of(float value) const;
};

}  // namespace inkwell::window
