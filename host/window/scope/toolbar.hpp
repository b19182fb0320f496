// The scope's controls: pause, time shown, cursors, statistics, trigger.
#pragma once

#include <frame/style.hpp>
#include <scope/timeline.hpp>

#include "cursors.hpp"
#include "signal_list.hpp"

namespace inkwell::window {

/// Continues the row of what was drawn last.
void draw_toolbar(Timeline& timeline, Cursors& cursors, bool& with_statistics, SignalList& signals, const Style& style);

}  // namespace inkwell::window
