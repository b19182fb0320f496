#include "firmware/control/supervision/supervisor.hpp"

#include <array>
#include <bit>
#include <cstddef>

namespace inkwell::control {

namespace {

using protocol::Conditions;
using protocol::Event;
using protocol::Events;
using protocol::Fault;
using protocol::State;
using protocol::StateTransition;

/// The interrupt reads this copy, because the original table may be in flash.
constexpr auto transitions = protocol::transition_table;

/// Collects the table entries of one state, so that the interrupt reads only one row.
struct OfState {
  Conditions monitored;
  Events key_events;   ///< key events of all transitions from the state
  Events idle_events;  ///< values of the key events for which every transition is closed
  const StateTransition* transitions_begin = nullptr;
  const StateTransition* transitions_end = nullptr;
};

/// Returns one event that can keep the transition closed. Events at the end of the event list are rare, so the last
/// event is used.
constexpr Events key_event(const StateTransition& transition) {
  return Events(std::bit_floor((transition.needs.any() ? transition.needs : transition.unless).bits()));
}

constexpr OfState rows_of(State state) {
  OfState rows;
  rows.monitored = protocol::conditions([state](const auto& row) { return row.monitored_in.contains(state); });
  for (const StateTransition& transition : transitions) {
    if (transition.from != state) continue;
    if (rows.transitions_begin == nullptr) rows.transitions_begin = &transition;
    rows.transitions_end = &transition + 1;
    rows.key_events |= key_event(transition);
    if (!transition.needs.any()) rows.idle_events |= key_event(transition);
  }
  return rows;
}

constexpr auto of_state = []() {
  std::array<OfState, protocol::state_count> result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = rows_of(static_cast<State>(i));
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

/// A fault cannot be cleared while the condition in its entry is present.
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
  return ((situation.found & here.monitored).bits() |
          ((situation.events ^ here.idle_events) & here.key_events).bits()) == 0;
}

Supervisor advance(const Supervisor& supervisor, const Situation& situation) {
  const OfState& here = of_state[static_cast<std::size_t>(supervisor.state)];
  if (const Conditions found = situation.found & here.monitored; found.any()) [[unlikely]]
    return {State::fault, faults[static_cast<std::size_t>(std::countr_zero(found.bits()))]};
  Events now = situation.events;
  if (supervisor.state == State::fault) [[unlikely]]
    now |= protocol::when(Event::cause,
                          (situation.found & clearing_blocker[static_cast<std::size_t>(supervisor.fault)]).any());
  // The state `update` retains the reported fault.
  now |= protocol::when(Event::raised, supervisor.fault != Fault::none);
  for (const StateTransition* transition = here.transitions_begin; transition != here.transitions_end; ++transition)
    if (transition->is_open(now))
      return {transition->to,
              transition->to == State::update || transition->to == State::fault ? supervisor.fault : Fault::none};
  return supervisor;
}

}  // namespace inkwell::control
