// Drawing of plots on ImGui's draw lists: frame, grid, lines of any length, cursors.
#pragma once

#include <span>
#include <string>

#include <window/plot_axis.hpp>
#include <window/signal_history.hpp>

#include "style.hpp"

namespace inkwell::window {

/// A rectangle of the screen with a range on each axis.
struct PlotArea {
  ImVec2 minimum;  ///< top left
  ImVec2 maximum;  ///< bottom right
  AxisRange x;
  AxisRange y;

  float width() const { return maximum.x - minimum.x; }
  float height() const { return maximum.y - minimum.y; }
  float to_x(double value) const { return minimum.x + static_cast<float>(x.part(value)) * width(); }
  float to_y(double value) const { return maximum.y - static_cast<float>(y.part(value)) * height(); }
};

/// Ground, grid and the numbers on both axes. `x_unit` and `y_unit` stand at the ends of the axes.
/// `x_is_logarithm`: the x axis holds powers of ten, which are written out.
void draw_axes(ImDrawList& list, const PlotArea& area, const Style& style, const std::string& x_unit,
               const std::string& y_unit, bool x_is_logarithm = false);

/// A signal over [first, last) of its samples, which the whole width shows. Columns with many samples are drawn
/// from their smallest to their largest value, so no spike is lost.
void draw_signal(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                 Colour colour, const Style& style);

/// Points in the units of the axes, joined; NaN makes a gap.
void draw_points(ImDrawList& list, const PlotArea& area, std::span<const std::pair<double, double>> points,
                 Colour colour, const Style& style);

}  // namespace inkwell::window
