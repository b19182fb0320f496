// Draws the paper's figures 11 to 14 with gnuplot.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/client/recording/gnuplot.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/lab/experiment/summary.hpp"

namespace inkwell::experiment {

/// Returns the mean, smallest and largest value of each quantity in each millisecond. In a longer interval, the points
/// are longer, so that the figures stay small.
recording::FigureData figure_data(const recording::StoredRecording& recording, BoxWall wall, Interval shown);

struct PaperFigureOptions {
  std::optional<BoxWall> wall;   ///< std::nullopt: the wall with the deepest penetration
  std::optional<double> from_s;  ///< since the first sample; std::nullopt: shortly before the contact
  std::optional<double> to_s;    ///< std::nullopt: shortly after the contact
};

/// Creates the folder and writes figure-11.png to figure-14.png. Writes figures.gnuplot and figure-data.csv, so that
/// users can redraw the figures. Returns the four pictures. Throws device::Error if a signal was not recorded, the wall
/// was not touched, or the time range contains no samples. Throws device::Error if a file cannot be written or if
/// gnuplot fails.
std::vector<std::string> draw_figures(const recording::StoredRecording& recording,
                                      const std::filesystem::path& directory, const PaperFigureOptions& options);

}  // namespace inkwell::experiment
