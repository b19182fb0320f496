#include "firmware/control/supervision/supervisor.hpp"

#include <array>
#include <bit>
#include <cstddef>

namespace inkwell::control {

namespace {

using protocol::Conditions;
using protocol::Event;
using protocol::Fault;
using protocol::State;
using protocol::StateTransition;

/// The table is copied, because a table in a header may be in flash.
constexpr auto transitions = protocol::transition_table;

/// The table is indexed by state, so that an interrupt reads only one row.
struct OfState {
  Conditions monitored = 0;
  protocol::Events idle_events = 0;  ///< values of the `key_events` events for which every transition is closed
  protocol::Events key_events = 0;
  const StateTransition* transitions_begin = nullptr;
  const StateTransition* transitions_end = nullptr;
};

constexpr auto of_state = []() {
  std::array<OfState, protocol::state_count> result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto state = static_cast<State>(i);
    OfState& here = result[i];
    here.monitored = protocol::conditions([state](const auto& row) { return row.monitored_in.contains(state); });
    for (const StateTransition& transition : transitions) {
      if (transition.from != state) continue;
      if (here.transitions_begin == nullptr) here.transitions_begin = &transition;
      here.transitions_end = &transition + 1;
      // A transition is impossible if a needed event is missing or if an excluded event occurs. The last event in the
      // event list is used, because it is the rarest event.
      const protocol::Events key = std::bit_floor(transition.needs != 0 ? transition.needs : transition.unless);
      here.key_events |= key;
      if (transition.needs == 0) here.idle_events |= key;
    }
  }
  return result;
}();

constexpr bool every_transition_is_closed_when_idle() {
  for (const StateTransition& transition : transitions)
    if (transition.is_open(of_state[static_cast<std::size_t>(transition.from)].idle_events)) return false;
  return true;
}
static_assert(every_transition_is_closed_when_idle());

constexpr auto faults = []() {
  std::array<Fault, protocol::condition_table.size()> result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = protocol::condition_table[i].fault;
  return result;
}();

/// The user cannot clear a fault while the condition in its entry is present.
constexpr auto clearing_blocker = []() {
  std::array<Conditions, protocol::fault_code_end> result{};
  for (const auto& row : protocol::condition_table)
    if (row.clearing != protocol::Clearing::at_once)
      result[static_cast<std::size_t>(row.fault)] = protocol::condition(row.fault);
  return result;
}();

}  // namespace

bool stays_unchanged(State state, const Situation& situation) {
  const OfState& here = of_state[static_cast<std::size_t>(state)];
  return ((situation.found & here.monitored) | ((situation.events ^ here.idle_events) & here.key_events)) == 0;
}

Supervisor advance(const Supervisor& supervisor, const Situation& situation) {
  const OfState& here = of_state[static_cast<std::size_t>(supervisor.state)];
  if (const Conditions found = situation.found & here.monitored; found != 0) [[unlikely]]
    return {State::fault, faults[static_cast<std::size_t>(std::countr_zero(found))]};
  protocol::Events now = situation.events;
  if (supervisor.state == State::fault) [[unlikely]]
    now |= protocol::when(Event::cause,
                          (situation.found & clearing_blocker[static_cast<std::size_t>(supervisor.fault)]) != 0);
  // In the state `update` the reported fault is still stored.
  now |= protocol::when(Event::raised, supervisor.fault != Fault::none);
  for (const StateTransition* transition = here.transitions_begin; transition != here.transitions_end; ++transition)
    if (transition->is_open(now))
      return {transition->to,
              transition->to == State::update || transition->to == State::fault ? supervisor.fault : Fault::none};
  return supervisor;
}

}  // namespace inkwell::control
