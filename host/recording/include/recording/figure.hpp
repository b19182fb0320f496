// A figure of a recording: signals against time, one pane for each unit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <recording/overlay.hpp>
#include <recording/recording.hpp>

namespace inkwell::recording {

struct FigureOptions {
  std::vector<Quantity> quantities;  ///< empty: all that were recorded
  double from_s = 0;                 ///< since the first sample
  std::optional<double> to_s;        ///< without it, the last sample
  const Overlay* over = nullptr;     ///< drawn with broken lines, as far as it holds the quantities; null: none
};

/// Quantities of one unit, in the order in which they are drawn.
struct FigurePane {
  std::string label;  ///< of its axis: what is drawn and its unit
  std::vector<Quantity> quantities;
};

std::vector<FigurePane> figure_panes(const std::vector<Quantity>& quantities);

/// Draws a PNG by gnuplot. Throws device::Error with a sentence if a quantity was not recorded, the stretch of time
/// holds no samples, the picture cannot be written, or gnuplot fails.
void draw_figure(const Recording& recording, const FigureOptions& options, const std::filesystem::path& picture);

}  // namespace inkwell::recording
