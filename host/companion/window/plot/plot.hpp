// Draws grids, axis numbers and lines into ImGui draw lists.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/plot/line_pieces.hpp"
#include "host/companion/window/plot/line_thinning.hpp"
#include "host/companion/window/plot/plot_axis.hpp"

namespace inkwell::window {

/// A screen rectangle with a range for each axis.
struct PlotArea {
  ImVec2 minimum;  ///< top left corner
  ImVec2 maximum;  ///< bottom right corner
  AxisRange x;
  AxisRange y;
  double x_shown_factor = 1.0;  ///< the numbers at the axis are the values times this factor
  double y_shown_factor = 1.0;

  float width() const { return maximum.x - minimum.x; }
  float height() const { return maximum.y - minimum.y; }
  float to_x(double value) const { return minimum.x + static_cast<float>(x.part(value)) * width(); }
  float to_y(double value) const { return maximum.y - static_cast<float>(y.part(value)) * height(); }
};

/// Returns the thickness in whole pixels, for which ImGui needs only a third of the triangles.
inline float line_thickness(const Style& style) { return std::round(style.points(1.5f)); }

/// Draws a line that may have gaps.
class Polyline {
 public:
  Polyline(ImDrawList& list, ImU32 colour, float thickness) : list_(list), colour_(colour), thickness_(thickness) {}
  ~Polyline() { finish(); }
  Polyline(const Polyline&) = delete;
  Polyline& operator=(const Polyline&) = delete;

  void add(float x, float y) { line_.add({x, y}); }
  void finish() {
    const std::vector<ImVec2> points = line_.take();
    for (const auto piece : pieces_between_turns(std::span<const ImVec2>(points)))
      list_.AddPolyline(piece.data(), static_cast<int>(piece.size()), colour_, 0, thickness_);
  }

 private:
  ImDrawList& list_;
  ImU32 colour_;
  float thickness_;
  LineThinning<ImVec2> line_;
};

/// Draws the background, the grid and the numbers at the axes. `x_unit` and `y_unit` are drawn at the ends of the axes.
/// If `x_is_logarithm` is true, x values are exponents of ten, and the axis shows the powers.
void draw_axes(ImDrawList& list, const PlotArea& area, const Style& style, const std::string& x_unit,
               const std::string& y_unit, bool x_is_logarithm = false);

/// Draws a line through points in axis units. NaN interrupts the line.
void draw_points(ImDrawList& list, const PlotArea& area, std::span<const std::pair<double, double>> points,
                 Colour colour, const Style& style);

}  // namespace inkwell::window
