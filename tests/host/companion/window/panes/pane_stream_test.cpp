#include <doctest/doctest.h>

#include <vector>

#include "host/companion/window/panes/pane_stream.hpp"
#include "protocol/reports.hpp"

using namespace inkwell;
using protocol::Signal;

TEST_CASE("joined appends the signals of a pane to the signals of the scope without repetition, up to the maximum") {
  using Signals = std::vector<Signal>;
  CHECK(window::joined({Signal::force_N, Signal::duty_1}, Signals{Signal::supply_V, Signal::force_N}) ==
        Signals{Signal::force_N, Signal::duty_1, Signal::supply_V});
  CHECK(window::joined({}, Signals{Signal::supply_V, Signal::supply_V}) == Signals{Signal::supply_V});
  CHECK(window::joined({Signal::force_N}, Signals{}) == Signals{Signal::force_N});

  Signals almost_full;
  for (std::size_t i = 0; i + 1 < protocol::scope_signals_maximum; ++i) almost_full.push_back(static_cast<Signal>(i));
  const Signals full = window::joined(almost_full, Signals{Signal::supply_V, Signal::motor_heat_1});
  CHECK(full.size() == protocol::scope_signals_maximum);
  CHECK(full.back() == Signal::supply_V);
}
