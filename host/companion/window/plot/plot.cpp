#include "host/companion/window/plot/plot.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace inkwell::window {

namespace {

constexpr float y_ticks_every_points = 34.0f;
constexpr float x_ticks_every_points = 84.0f;

// Converts the exponent 3 to "1k".
std::string power_label(double exponent) {
  return exponent < 3.0 ? fmt::format("{:g}", std::pow(10.0, exponent))
                        : fmt::format("{:g}k", std::pow(10.0, exponent - 3.0));
}

}  // namespace

void draw_axes(ImDrawList& list, const PlotArea& area, const Style& style, const std::string& x_unit,
               const std::string& y_unit, bool x_is_logarithm) {
  const Palette& palette = *style.palette;
  ImFont* font = style.fonts.caption;
  const float size = font->FontSize;

  const auto shown = [](const AxisRange& range, double factor) {
    return AxisRange{factor * range.minimum, factor * range.maximum};
  };
  const std::vector<double> y_ticks =
      ticks(shown(area.y, area.y_shown_factor),
            std::max(3, static_cast<int>(area.height() / style.points(y_ticks_every_points))));
  const double y_step = y_ticks.size() > 1 ? y_ticks[1] - y_ticks[0] : area.y_shown_factor * area.y.extent();
  for (double value : y_ticks) {
    const float y = std::round(area.to_y(value / area.y_shown_factor));
    list.AddLine({area.minimum.x, y}, {area.maximum.x, y}, packed(palette.plot_grid));
    const std::string label = tick_label(value, y_step);
    const ImVec2 taken = font->CalcTextSizeA(size, 1e4f, 0, label.c_str());
    list.AddText(font, size, {area.minimum.x - taken.x - style.points(6), y - 0.5f * taken.y},
                 packed(palette.text_quiet), label.c_str());
  }
  const std::vector<double> x_ticks =
      ticks(shown(area.x, area.x_shown_factor), static_cast<int>(area.width() / style.points(x_ticks_every_points)));
  const double x_step = x_ticks.size() > 1 ? x_ticks[1] - x_ticks[0] : area.x_shown_factor * area.x.extent();
  for (double value : x_ticks) {
    const float x = std::round(area.to_x(value / area.x_shown_factor));
    list.AddLine({x, area.minimum.y}, {x, area.maximum.y}, packed(palette.plot_grid));
    if (x_is_logarithm && value != std::round(value)) continue;
    std::string label = x_is_logarithm ? power_label(value) : tick_label(value, x_step);
    if (value == x_ticks.back()) label += " " + x_unit;
    const ImVec2 taken = font->CalcTextSizeA(size, 1e4f, 0, label.c_str());
    const float left =
        std::clamp(x - 0.5f * taken.x, area.minimum.x, std::max(area.minimum.x, area.maximum.x - taken.x));
    list.AddText(font, size, {left, area.maximum.y + style.points(3)}, packed(palette.text_quiet), label.c_str());
  }
  if (!y_unit.empty())
    list.AddText(font, size, {area.minimum.x + style.points(5), area.minimum.y + style.points(2)},
                 packed(palette.text_quiet), y_unit.c_str());
}

void draw_points(ImDrawList& list, const PlotArea& area, std::span<const std::pair<double, double>> points,
                 Colour colour, const Style& style) {
  list.PushClipRect(area.minimum, area.maximum, true);
  {
    Polyline line(list, packed(colour), line_thickness(style));
    for (const auto& [x, y] : points) {
      if (std::isnan(x) || std::isnan(y)) {
        line.finish();
      } else {
        line.add(area.to_x(x), area.to_y(y));
      }
    }
  }
  list.PopClipRect();
}

}  // namespace inkwell::window
