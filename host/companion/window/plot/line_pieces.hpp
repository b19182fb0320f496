// Splits a line at sharp turns, because ImGui draws sharp turns with invisible joints.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace inkwell::window {

/// Splits the points at each turn of more than 120 degrees. Adjacent pieces share the turning point.
template <class Point>
std::vector<std::span<const Point>> pieces_between_turns(std::span<const Point> line) {
  constexpr float sharpest_cosine = -0.5f;
  std::vector<std::span<const Point>> pieces;
  std::size_t begin = 0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const float in_x = line[i].x - line[i - 1].x, in_y = line[i].y - line[i - 1].y;
    const float out_x = line[i + 1].x - line[i].x, out_y = line[i + 1].y - line[i].y;
    const float lengths = std::sqrt((in_x * in_x + in_y * in_y) * (out_x * out_x + out_y * out_y));
    if (in_x * out_x + in_y * out_y >= sharpest_cosine * lengths) continue;
    pieces.push_back(line.subspan(begin, i - begin + 1));
    begin = i;
  }
  if (line.size() > begin + 1) pieces.push_back(line.subspan(begin));
  return pieces;
}

}  // namespace inkwell::window
