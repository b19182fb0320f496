// The controls of the scope: pause, time span, cursors, statistics and trigger.
#pragma once

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/timeline.hpp"

#include "host/companion/window/scope/cursors.hpp"
#include "host/companion/window/scope/signal_list.hpp"

namespace inkwell::window {

/// Draws the controls in the same row as the last item.
void draw_toolbar(Timeline& timeline, Cursors& cursors, bool& with_statistics, SignalList& signals, bool is_replay,
                  const Style& style);

}  // namespace inkwell::window
