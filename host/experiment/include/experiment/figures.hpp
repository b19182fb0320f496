// The paper's figures 11 to 14, drawn by gnuplot from a recording.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <experiment/summary.hpp>
#include <recording/gnuplot.hpp>
#include <recording/recording.hpp>

namespace inkwell::experiment {

/// Mean, smallest and largest value of each millisecond of what the figures show.
recording::FigureData figure_data(const recording::Recording& recording, BoxWall wall);

struct PaperFigureOptions {
  std::optional<BoxWall> wall;   ///< without it the one that was pushed into deepest
  std::optional<double> from_s;  ///< since the first sample; without it a little before the contact
  std::optional<double> to_s;    ///< without it a little after the contact
};

/// Writes figure-11.png to figure-14.png, and figures.gnuplot with figure-data.csv from which they can be drawn
/// again, into a folder, which is made if it is missing. Returns the four pictures. Throws device::Error if a signal
/// was not recorded, the wall was not touched, the stretch of time holds no samples, a file cannot be written, or
/// gnuplot fails, in its own words.
std::vector<std::string> draw_figures(const recording::Recording& recording, const std::filesystem::path& directory,
                                      const PaperFigureOptions& options);

}  // namespace inkwell::experiment
