// The menu selects the type and the signals of a plot.
#pragma once

#include <span>
#include <string>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/scope_layout.hpp"

namespace inkwell::window {

/// Draws the open menu. Returns true if the user removes the plot.
bool draw_plot_menu(ScopePlot& plot, std::span<const Formula> formulas, bool may_be_removed, const Style& style);

}  // namespace inkwell::window
