// How the scope writes numbers and tells its signals apart: the line above a plot, with which colour is which signal
// and its values at the cursors.
#pragma once

#include <string>

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

#include "plot_view.hpp"

namespace inkwell::window {

/// Four digits; a dash where there is no value (NaN).
std::string formatted(double value);

/// Without its unit: "force_N" -> "force".
std::string short_name(const ScopeSignal& signal);

/// The signals of one y axis usually share a unit, which then stands once at the axis; else empty.
std::string common_unit(const ScopePlot& plot);

Colour line_colour(const Style& style, std::size_t index);
/// Of the same signal in a recording that is laid over.
Colour laid_over_colour(const Style& style, std::size_t index);

/// What the line above a plot takes where there is room for all of it.
float legend_width(const ScopePlot& plot, const Style& style);

/// The line above a plot: its unit at the left, its signals at the right of `width`, as much of them as there is room
/// for.
void draw_legend(const ScopePlot& plot, ImVec2 place, float width, const ScopeFrame& frame);

}  // namespace inkwell::window
