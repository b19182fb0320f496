#include "host/companion/window/panes/pane_stream.hpp"

#include <algorithm>

#include "protocol/reports.hpp"

namespace inkwell::window {

std::vector<protocol::Signal> joined(std::vector<protocol::Signal> signals, std::span<const protocol::Signal> more) {
  for (const protocol::Signal signal : more)
    if (signals.size() < protocol::scope_signals_maximum && std::ranges::find(signals, signal) == signals.end())
      signals.push_back(signal);
  return signals;
}

}  // namespace inkwell::window
