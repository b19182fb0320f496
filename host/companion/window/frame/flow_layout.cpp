#include "host/companion/window/frame/flow_layout.hpp"

#include <numeric>

namespace inkwell::window {

std::vector<FlowPosition> flow(std::span<const float> widths, float first_row_width, float row_width, float gap) {
  std::vector<FlowPosition> positions;
  if (widths.empty()) return positions;
  const float all = std::accumulate(widths.begin(), widths.end(), 0.0f) + gap * static_cast<float>(widths.size() - 1);
  const bool one_row = all <= first_row_width;
  int row = widths.front() <= first_row_width ? 0 : 1;
  float x = 0.0f;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const bool leaves_first_row = !one_row && i == 1 && row == 0;
    const bool is_full = !one_row && x > 0.0f && x + widths[i] > row_width;
    if (leaves_first_row || is_full) {
      ++row;
      x = 0.0f;
    }
    positions.push_back({row, x});
    x += widths[i] + gap;
  }
  return positions;
}

}  // namespace inkwell::window
