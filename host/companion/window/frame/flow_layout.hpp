// Layout of items in rows. The rows wrap in a narrow window or with large text.
#pragma once

#include <span>
#include <vector>

namespace inkwell::window {

struct FlowPosition {
  int row;
  float x;  ///< from the left end of the row
};

/// Puts all items in the first row if `first_row_width` is sufficient. If the width is not sufficient, the first row
/// contains only the first item, and the next rows have the width `row_width`.
std::vector<FlowPosition> flow(std::span<const float> widths, float first_row_width, float row_width, float gap);

}  // namespace inkwell::window
