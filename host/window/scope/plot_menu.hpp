// The menu of a plot, which opens from its title.
#pragma once

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

namespace inkwell::window {

/// Draws the popup "plot menu" while it is open: the plot's kind and signals. True if the plot is to be removed.
bool draw_plot_menu(ScopePlot& plot, bool may_be_removed, const Style& style);

}  // namespace inkwell::window
