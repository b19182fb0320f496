// Common code of all figures.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/recording/band.hpp"

namespace inkwell::recording {

/// Data of a figure: bands over time.
struct FigureData {
  struct Row {
    double time_s;
    std::vector<Band> bands;  ///< one for each name
  };
  std::vector<std::string> names;
  std::vector<Row> rows;

  /// Writes a CSV file for the script. Throws device::Error if the file cannot be written completely.
  void write(const std::filesystem::path& file) const;
};

struct Curve {
  std::string name;   ///< name of the band in the data
  std::string style;  ///< color (a variable of figure_head) and other line properties
  std::string title;  ///< legend text; empty if the axis shows it
};

/// Start of a script: data file, picture size in pixels, fonts, colors and axes.
std::string figure_head(const std::string& data_file, int width, int height);
/// Title and subtitle above the next plot. The distance of both titles to the picture's upper edge is in pixels.
std::string figure_titles(std::string_view title, std::string_view subtitle, int height);
/// Lines and bands against time_s.
std::string plot_command(const std::vector<Curve>& curves);
/// Converts any text to a quoted gnuplot string. The text is converted to plain text first.
std::string gnuplot_text(std::string_view text);

/// Runs a script in its folder, without the user's gnuplot settings. Throws device::Error with gnuplot's output if the
/// script fails.
void run_gnuplot(const std::filesystem::path& script);

}  // namespace inkwell::recording
