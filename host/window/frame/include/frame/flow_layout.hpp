// Rows of items that wrap if the window is narrow or its text is large.
#pragma once

#include <span>
#include <vector>

namespace inkwell::window {

struct FlowPlace {
  int row;
  float x;  ///< from the left end of the row
};

/// Puts all items in the first row if they fit into `first_row_width`, which other items may share. Otherwise only the
/// first item stays there, and the others fill rows of `row_width`.
std::vector<FlowPlace> flow(std::span<const float> widths, float first_row_width, float row_width, float gap);

}  // namespace inkwell::window
