// Lines of signals in a plot, from single samples to minutes.
#pragma once

#include <plot/plot.hpp>
#include <scope/signal_history.hpp>

namespace inkwell::window {

/// Draws the samples [first, last) of a signal over the whole width. Columns with many samples are drawn from minimum
/// to maximum, so that no spike is lost.
void draw_signal(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                 Colour colour, const Style& style);

}  // namespace inkwell::window
