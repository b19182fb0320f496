// The menu of a plot's title: kind and signals of the plot.
#pragma once

#include <span>
#include <string>

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

namespace inkwell::window {

/// Draws the menu while it is open. Returns true if the plot is to be removed.
bool draw_plot_menu(ScopePlot& plot, std::span<const Formula> formulas, bool may_be_removed, const Style& style);

}  // namespace inkwell::window
