// Files of plots: CSV with the values of the view, and SVG drawings.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "host/companion/window/frame/palette.hpp"
#include "host/companion/window/plot/plot_axis.hpp"

namespace inkwell::window {

/// The displayed values of a plot. A lost sample is NaN.
struct PlotTable {
  std::string title;
  std::string x_name;                       ///< with the unit, such as "time_s"
  std::vector<double> x;                    ///< increasing, except in a plot of signals against each other
  std::vector<std::string> names;           ///< with the units
  std::vector<std::vector<float>> columns;  ///< one for each name, with the length of `x`
  bool x_increases = true;
  AxisRange x_range{0, 1};
  AxisRange y_range{0, 1};
};

/// A line of a plot.
struct NamedPoints {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x increases
};

/// Returns the points of all lines in a range of x. A line without a point at an x of another line has the value NaN
/// there. The names become column names with letters, digits and "_".
PlotTable table_of(const std::vector<NamedPoints>& lines, const AxisRange& x_range);

/// Returns a header line and a line per value. A lost sample is an empty field.
std::string csv_of(const PlotTable& table);

/// Returns a drawing with axes, legend and lines. Several samples in a column of pixels become a line from the smallest
/// value to the largest value.
std::string svg_of(const PlotTable& table, const Palette& palette);

/// Writes a text file. Returns an error message; empty on success.
std::string write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace inkwell::window
