#include "plot.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <window/line_thinning.hpp>

namespace inkwell::window {

namespace {

// Rounded to whole pixels, which ImGui draws with a third of the triangles.
constexpr float line_points = 1.5f;
constexpr float pixels_per_column = 2.0f;
constexpr float y_ticks_every_points = 34.0f;
constexpr float x_ticks_every_points = 84.0f;

// Collects a line's points and draws them whenever there is a gap.
class Polyline {
 public:
  Polyline(ImDrawList& list, ImU32 colour, float thickness) : list_(list), colour_(colour), thickness_(thickness) {}
  ~Polyline() { finish(); }
  Polyline(const Polyline&) = delete;
  Polyline& operator=(const Polyline&) = delete;

  void add(float x, float y) { line_.add({x, y}); }
  void finish() {
    const std::vector<ImVec2> points = line_.take();
    if (points.size() > 1) list_.AddPolyline(points.data(), static_cast<int>(points.size()), colour_, 0, thickness_);
  }

 private:
  ImDrawList& list_;
  ImU32 colour_;
  float thickness_;
  LineThinning<ImVec2> line_;
};

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

// 3 -> "1k"
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

  const std::vector<double> y_ticks =
      ticks(area.y, std::max(3, static_cast<int>(area.height() / style.points(y_ticks_every_points))));
  const double y_step = y_ticks.size() > 1 ? y_ticks[1] - y_ticks[0] : area.y.extent();
  for (double value : y_ticks) {
    const float y = std::round(area.to_y(value));
    list.AddLine({area.minimum.x, y}, {area.maximum.x, y}, packed(palette.plot_grid));
    const std::string label = tick_label(value, y_step);
    const ImVec2 taken = font->CalcTextSizeA(size, 1e4f, 0, label.c_str());
    list.AddText(font, size, {area.minimum.x - taken.x - style.points(6), y - 0.5f * taken.y},
                 packed(palette.text_quiet), label.c_str());
  }
  const std::vector<double> x_ticks =
      ticks(area.x, static_cast<int>(area.width() / style.points(x_ticks_every_points)));
  const double x_step = x_ticks.size() > 1 ? x_ticks[1] - x_ticks[0] : area.x.extent();
  for (double value : x_ticks) {
    const float x = std::round(area.to_x(value));
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

void draw_signal(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                 Colour colour, const Style& style) {
  const auto columns = static_cast<std::size_t>(std::max(area.width() / pixels_per_column, 1.0f));
  const float thickness = std::round(style.points(line_points));
  list.PushClipRect(area.minimum, area.maximum, true);
  if (last - first < 2.0 * static_cast<double>(columns)) {
    draw_samples(list, area, series, first, last, colour, thickness);
  } else {
    draw_columns(list, area, decimate(series, first, last, columns), colour, thickness);
  }
  list.PopClipRect();
}

void draw_points(ImDrawList& list, const PlotArea& area, std::span<const std::pair<double, double>> points,
                 Colour colour, const Style& style) {
  list.PushClipRect(area.minimum, area.maximum, true);
  {
    Polyline line(list, packed(colour), std::round(style.points(line_points)));
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
