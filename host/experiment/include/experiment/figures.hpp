// The paper's figures 11 to 14, drawn by gnuplot from a recording.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

/// The part of the time axis that shows the contact and a little around it.
Interval interval_to_show(Interval contact, std::size_t samples);

/// Whether a file is the recording.csv of an experiment, by its first line.
bool is_experiment(const std::filesystem::path& file);

/// Draws the figures of an experiment again, from its recording.csv and the summary.json beside it, into a folder;
/// times since the first sample narrow what is shown. Returns the four pictures. Throws device::Error.
std::vector<std::string> redraw_figures(const std::filesystem::path& recording, const std::filesystem::path& directory,
                                        double from_s, std::optional<double> to_s);

}  // namespace inkwell::experiment
