// What the device may do: one step through the tables of protocol/supervision.hpp.
#pragma once

#include <protocol/supervision.hpp>

namespace inkwell::control {

/// What is so in this period, and what was asked for since the one before.
struct Situation {
  protocol::Events events = 0;
  protocol::Watches found = 0;  ///< also where nobody looks for it
};

struct Supervisor {
  protocol::State state = protocol::State::starting;
  protocol::Fault fault = protocol::Fault::none;
  bool operator==(const Supervisor&) const = default;
};

/// Whether no fault is found and no way is open, for most of all periods; false means that nothing is known.
bool surely_stays(protocol::State state, const Situation& situation);

/// The state in the next period. `Event::cause` is added here.
[[gnu::cold]] Supervisor advance(const Supervisor& supervisor, const Situation& situation);

}  // namespace inkwell::control
