// Lines of signals in a plot, from single samples to minutes of them.
#pragma once

#include <plot/plot.hpp>
#include <scope/signal_history.hpp>

namespace inkwell::window {

/// A signal over [first, last) of its samples, which the whole width shows. Columns with many samples are drawn
/// from their smallest to their largest value, so no spike is lost.
void draw_signal(ImDrawList& list, const PlotArea& area, const SignalSeries& series, double first, double last,
                 Colour colour, const Style& style);

}  // namespace inkwell::window
