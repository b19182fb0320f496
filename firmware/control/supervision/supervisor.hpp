// State machine of the board, with the tables of protocol/supervision.hpp.
#pragma once

#include "protocol/supervision.hpp"

namespace inkwell::control {

/// Conditions and requests of one period.
struct Situation {
  protocol::Events events;
  protocol::Conditions found;  ///< includes faults that the state does not monitor
};

struct Supervisor {
  protocol::State state = protocol::State::starting;
  protocol::Fault fault = protocol::Fault::none;
  bool operator==(const Supervisor&) const = default;
};

/// Returns true if no fault is found and no transition is possible. If the result is false, call advance().
bool stays_unchanged(protocol::State state, const Situation& situation);

/// Returns the state of the next period. This function sets `Event::cause`.
[[gnu::cold]] Supervisor advance(const Supervisor& supervisor, const Situation& situation);

}  // namespace inkwell::control
