// Rows of items that wrap where a window is narrow or its text large.
#pragma once

#include <span>
#include <vector>

namespace inkwell::window {

struct FlowPlace {
  int row;
  float x;  ///< from the left end of the row
};

/// Everything in one row if it fits into `first_row_width`, which other things may share. Otherwise only the first item
/// stays there, and the others fill rows of `row_width`.
std::vector<FlowPlace> flow(std::span<const float> widths, float first_row_width, float row_width, float gap);

}  // namespace inkwell::window
