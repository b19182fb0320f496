// Number format of the scope, and the legend above a plot.
#pragma once

#include <string>

#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/scope_layout.hpp"

#include "host/companion/window/scope/plot_view.hpp"
#include "host/companion/window/scope/statistics_text.hpp"

namespace inkwell::window {

/// Returns the name without the unit, such as "force" for "force_N".
std::string short_name(const ScopeSignal& signal);

/// Returns the common unit of all signals on the y axis; empty if the units differ.
std::string common_unit(const ScopePlot& plot);

/// Returns the common unit as the window shows it, such as "mm" for signals in meters.
ShownUnit common_shown_unit(const ScopePlot& plot);

Colour line_colour(const Style& style, std::size_t index);
/// Returns the color of a signal in an overlaid recording.
Colour laid_over_colour(const Style& style, std::size_t index);

/// Returns the width of the complete legend.
float legend_width(const ScopePlot& plot, const Style& style);

/// Draws the legend above a plot, shortened to `width`.
void draw_legend(const ScopePlot& plot, ImVec2 origin, float width, const PlotFrame& frame);

}  // namespace inkwell::window
