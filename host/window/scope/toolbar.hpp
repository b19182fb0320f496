// The controls of the scope: pause, time span, cursors, statistics and trigger.
#pragma once

#include <frame/style.hpp>
#include <scope/timeline.hpp>

#include "cursors.hpp"
#include "signal_list.hpp"

namespace inkwell::window {

/// Draws the controls in the same row as the last item.
void draw_toolbar(Timeline& timeline, Cursors& cursors, bool& with_statistics, SignalList& signals, const Style& style);

}  // namespace inkwell::window
