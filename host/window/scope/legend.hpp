// Number format of the scope, and the legend line above a plot: signal colors, names and values at the cursors.
#pragma once

#include <string>

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

#include "plot_view.hpp"

namespace inkwell::window {

/// Formats four digits, or a dash for NaN.
std::string formatted(double value);

/// Name without unit: "force_N" -> "force".
std::string short_name(const ScopeSignal& signal);

/// Returns the unit if all signals of the y axis have the same; otherwise empty.
std::string common_unit(const ScopePlot& plot);

Colour line_colour(const Style& style, std::size_t index);
/// Color of the same signal in an overlaid recording.
Colour laid_over_colour(const Style& style, std::size_t index);

/// Width of the complete line above a plot.
float legend_width(const ScopePlot& plot, const Style& style);

/// Draws the line above a plot: the unit on the left and the signals on the right, shortened to `width`.
void draw_legend(const ScopePlot& plot, ImVec2 place, float width, const ScopeFrame& frame);

}  // namespace inkwell::window
