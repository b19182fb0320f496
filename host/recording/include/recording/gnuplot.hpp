// What all figures have in common: their look, the band that stands for many samples, and gnuplot itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::recording {

/// Many samples in one point of a figure: a line is drawn through the means, a band from smallest to largest.
struct Band {
  double mean, minimum, maximum;
};

/// Of value_at(0) to value_at(count - 1); all NaN if there are none, which leaves a gap in the figure.
template <class ValueAt>
Band band_of(std::size_t count, ValueAt value_at) {
  if (count == 0) return {std::nan(""), std::nan(""), std::nan("")};
  double sum = 0, smallest = 0, largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = value_at(i);
    smallest = i == 0 ? value : std::min(smallest, value);
    largest = i == 0 ? value : std::max(largest, value);
    sum += value;
  }
  return {sum / static_cast<double>(count), smallest, largest};
}

/// What a figure draws: bands over time.
struct FigureData {
  struct Row {
    double time_s;
    std::vector<Band> bands;  ///< one for each name
  };
  std::vector<std::string> names;
  std::vector<Row> rows;

  /// As CSV, for the script beside it. Throws device::Error if it cannot be written whole.
  void write(const std::filesystem::path& file) const;
};

struct Curve {
  std::string name;   ///< of the band in the data
  std::string style;  ///< colour, a variable of figure_head, and what else belongs to the line
  std::string title;  ///< in the legend; none where the axis says it
};

/// Start of a script: data file, picture size in pixels, fonts, colours and axes.
std::string figure_head(const std::string& data_file, int width, int height);
/// Title and subtitle above the next plot. Their distance to the picture's upper edge is in pixels.
std::string figure_titles(std::string_view title, std::string_view subtitle, int height);
/// Lines and bands against time_s.
std::string plot_command(const std::vector<Curve>& curves);
/// A string for gnuplot, quotes included: it prints this text, made plain, whatever is in it.
std::string gnuplot_text(std::string_view text);

/// Runs a script in its folder, without settings of the user. Throws device::Error with gnuplot's words if it fails.
void run_gnuplot(const std::filesystem::path& script);

}  // namespace inkwell::recording
