// A figure of a recording: signals against time, one pane for each unit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/client/recording/overlay.hpp"
#include "host/client/recording/stored_recording.hpp"

namespace inkwell::recording {

struct FigureOptions {
  std::vector<Quantity> quantities;  ///< empty: all recorded quantities
  double from_s = 0;                 ///< since the first sample
  std::optional<double> to_s;        ///< std::nullopt: the last sample
  const Overlay* over = nullptr;     ///< recording drawn with broken lines; null: none
};

/// Quantities with the same unit, in drawing order.
struct FigurePane {
  std::string label;  ///< axis label: quantities and unit
  std::vector<Quantity> quantities;
};

std::vector<FigurePane> figure_panes(const std::vector<Quantity>& quantities);

/// Draws a PNG with gnuplot. Throws device::Error with a sentence if a quantity was not recorded, or the time range
/// contains no samples. Throws device::Error if the picture cannot be written or if gnuplot fails.
void draw_figure(const StoredRecording& recording, const FigureOptions& options, const std::filesystem::path& picture);

}  // namespace inkwell::recording
