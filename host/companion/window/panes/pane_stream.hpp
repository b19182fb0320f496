// Signals requested by a pane from the scope stream.
#pragma once

#include <span>
#include <vector>

#include "protocol/signals.hpp"

namespace inkwell::window {

/// Request of a pane for a stream with exactly these signals, in this order.
struct PaneStream {
  std::vector<protocol::Signal> signals;  ///< empty: no request
  bool feeds_scope = true;                ///< `signals` includes the signals of the scope
};

/// Appends the missing signals of `more` to `signals`, up to the size limit of a selection.
std::vector<protocol::Signal> joined(std::vector<protocol::Signal> signals, std::span<const protocol::Signal> more);

}  // namespace inkwell::window
