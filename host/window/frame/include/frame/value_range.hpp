// The range of a number that is dragged or typed: where in it a value lies, how far a drag goes, how it is written.
#pragma once

#include <string>

namespace inkwell::window {

struct ValueRange {
  float minimum;
  float maximum;
  int decimals;              ///< digits after the point with which a value is shown and to which a drag rounds
  bool logarithmic = false;  ///< equal ways are equal ratios; needs minimum > 0

  bool contains(float value) const { return value >= minimum && value <= maximum; }
  /// 0 at the minimum, 1 at the maximum.
  float part_of(float value) const;
  /// Where a drag by so many points of the screen leads from a value. A thousand points are the whole range.
  float dragged(float from, float points) const;
  std::string text_of(float value) const;
};

}  // namespace inkwell::window
