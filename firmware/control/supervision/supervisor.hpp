// State machine that applies the tables of protocol/supervision.hpp in each control period.
#pragma once

#include "protocol/supervision.hpp"

namespace inkwell::control {

/// Conditions in this period, and requests since the previous period.
struct Situation {
  protocol::Events events;
  protocol::Conditions found;  ///< includes faults that the state does not monitor
};

struct Supervisor {
  protocol::State state = protocol::State::starting;
  protocol::Fault fault = protocol::Fault::none;
  bool operator==(const Supervisor&) const = default;
};

/// Fast state check for most periods. Returns true if no fault is found and no transition is possible. If the result is
/// false, call advance().
bool stays_unchanged(protocol::State state, const Situation& situation);

/// Returns the state of the next period. This function itself determines `Event::cause`.
[[gnu::cold]] Supervisor advance(const Supervisor& supervisor, const Situation& situation);

}  // namespace inkwell::control
