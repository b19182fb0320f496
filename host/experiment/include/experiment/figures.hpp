// The paper's figures 11 to 14, drawn by gnuplot from a recording.
#pragma once

#include <filesystem>
#include <string>

#include <experiment/recording.hpp>
#include <experiment/summary.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::experiment {

struct FigureOptions {
  bool simulation = false;
  std::string arm;
  Wall wall;
  protocol::ParameterSet parameters{};
  Interval shown;  ///< part of the time axis that is drawn
};

/// Mean, smallest and largest value of each millisecond of what the figures show.
Recording figure_data(const Recording& recording, const FigureOptions& options);

/// Writes figure-11.png to figure-14.png, and figures.gnuplot with figure-data.csv from which they can be drawn
/// again. Throws device::Error with gnuplot's words if it fails.
void draw_figures(const Recording& recording, const FigureOptions& options, const std::filesystem::path& directory);

}  // namespace inkwell::experiment
