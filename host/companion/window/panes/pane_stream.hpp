// A pane's request for signals in the scope stream.
#pragma once

#include <span>
#include <vector>

#include "protocol/signals.hpp"

namespace inkwell::window {

/// A pane's request for a stream of exactly these signals.
struct PaneStream {
  std::vector<protocol::Signal> signals;  ///< empty: no request
  bool feeds_scope = true;                ///< `signals` includes the signals of the scope
};

/// Appends the missing signals of `more` to `signals`, up to the size limit of the stream.
std::vector<protocol::Signal> joined(std::vector<protocol::Signal> signals, std::span<const protocol::Signal> more);

}  // namespace inkwell::window
