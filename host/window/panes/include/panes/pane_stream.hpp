// Signals that a pane requests from the scope stream.
#pragma once

#include <span>
#include <vector>

#include <protocol/signals.hpp>

namespace inkwell::window {

/// Request of a pane that replaces the scope's selection: exactly these signals, in this order.
struct PaneStream {
  std::vector<protocol::Signal> signals;  ///< empty: no request
  bool feeds_scope = true;                ///< the scope's signals are included, so that the scope continues
};

/// Appends those of `more` that are not yet in `signals`, up to the size limit of a selection.
std::vector<protocol::Signal> joined(std::vector<protocol::Signal> signals, std::span<const protocol::Signal> more);

}  // namespace inkwell::window
