#include "host/companion/window/scope/signal_line.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inkwell::window {

namespace {

constexpr float pixels_per_column = 2.0f;

void draw_samples(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                  Colour colour, float thickness) {
  Polyline line(list, packed(colour), thickness);
  const auto begin = static_cast<std::uint64_t>(std::max(std::floor(first) - 1.0, static_cast<double>(series.begin())));
  const auto end = std::min(static_cast<std::uint64_t>(std::max(std::ceil(last) + 1.0, 0.0)), series.end());
  for (std::uint64_t i = begin; i < end; ++i) {
    const float value = series[i];
    if (std::isnan(value)) {
      line.finish();
      continue;
    }
    const double part = (static_cast<double>(i) - first) / (last - first);
    line.add(area.minimum.x + static_cast<float>(part) * area.width(), area.to_y(static_cast<double>(value)));
  }
}

void draw_columns(ImDrawList& list, const PlotArea& area, const std::vector<Extremes>& columns, Colour colour,
                  float thickness) {
  const ImU32 ink = packed(colour);
  Polyline line(list, ink, thickness);
  const float column_width = area.width() / static_cast<float>(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (std::isnan(columns[i].minimum)) {
      line.finish();
      continue;
    }
    const float x = area.minimum.x + (static_cast<float>(i) + 0.5f) * column_width;
    const float low = area.to_y(static_cast<double>(columns[i].minimum));
    const float high = area.to_y(static_cast<double>(columns[i].maximum));
    line.add(x, 0.5f * (low + high));
    if (low - high > thickness)
      list.AddRectFilled({x - 0.5f * column_width, high}, {x + 0.5f * column_width, low}, ink);
  }
}

}  // namespace

void draw_signal(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                 Colour colour, const Style& style) {
  const auto columns = static_cast<std::size_t>(std::max(area.width() / pixels_per_column, 1.0f));
  const float thickness = line_thickness(style);
  list.PushClipRect(area.minimum, area.maximum, true);
  if (last - first < 2.0 * static_cast<double>(columns)) {
    draw_samples(list, area, series, first, last, colour, thickness);
  } else {
    draw_columns(list, area, decimate(series, first, last, columns), colour, thickness);
  }
  list.PopClipRect();
}

}  // namespace inkwell::window
