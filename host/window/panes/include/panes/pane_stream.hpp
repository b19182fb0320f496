// What panes have streamed.
#pragma once

#include <span>
#include <vector>

#include <protocol/signals.hpp>

namespace inkwell::window {

/// What has to be streamed for a pane in place of the scope's signals: these, in this order, and no others.
struct PaneStream {
  std::vector<protocol::Signal> signals;  ///< none: the pane does not take the stream
  bool feeds_scope = true;                ///< the scope's signals are among them, so that it goes on
};

/// The signals, and behind them those of `more` that are not yet there, as far as a selection has room.
std::vector<protocol::Signal> joined(std::vector<protocol::Signal> signals, std::span<const protocol::Signal> more);

}  // namespace inkwell::window
