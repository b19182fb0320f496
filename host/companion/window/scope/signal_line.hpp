// Draws signals as lines in a plot.
#pragma once

#include "host/companion/window/plot/plot.hpp"
#include "host/companion/window/scope/signal_history.hpp"

namespace inkwell::window {

/// Draws the samples [first, last) of a signal. A pixel column with many samples is drawn from minimum to maximum, so
/// that every spike is visible.
void draw_signal(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                 Colour colour, const Style& style);

}  // namespace inkwell::window
