// The menu selects the type, the y range and the signals of a plot, and saves the plot.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/scope_layout.hpp"

namespace inkwell::window {

enum class PlotMenuChoice : std::uint8_t { none, remove, save_png, save_svg, save_csv, copy_statistics };

/// Draws the open menu. Returns the action of the chosen row.
PlotMenuChoice draw_plot_menu(ScopePlot& plot, std::span<const Formula> formulas, bool may_be_removed,
                              const Style& style);

}  // namespace inkwell::window
