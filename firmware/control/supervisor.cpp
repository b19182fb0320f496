#include <control/supervisor.hpp>

#include <array>
#include <bit>
#include <cstddef>

namespace inkwell::control {

namespace {

using protocol::Event;
using protocol::Fault;
using protocol::State;
using protocol::Watches;
using protocol::Way;

/// Local copy, because a table in a header may be in flash.
constexpr auto ways = protocol::way_table;

/// Row of a table indexed by state, so that an interrupt reads only one row.
struct OfState {
  Watches watched = 0;
  protocol::Events rest = 0;  ///< values of the `moved_by` events for which every transition is closed
  protocol::Events moved_by = 0;
  const Way* ways_begin = nullptr;
  const Way* ways_end = nullptr;
};

constexpr auto of_state = []() {
  std::array<OfState, protocol::state_count> result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto state = static_cast<State>(i);
    OfState& here = result[i];
    here.watched = protocol::watches([state](const auto& row) { return row.watched_in.contains(state); });
    for (const Way& way : ways) {
      if (way.from != state) continue;
      if (here.ways_begin == nullptr) here.ways_begin = &way;
      here.ways_end = &way + 1;
      // A single missing or excluded event closes a transition. The last event in the event list is used, because it is
      // the rarest event.
      const protocol::Events key = std::bit_floor(way.needs != 0 ? way.needs : way.unless);
      here.moved_by |= key;
      if (way.needs == 0) here.rest |= key;
    }
  }
  return result;
}();

constexpr bool every_way_is_closed_at_rest() {
  for (const Way& way : ways)
    if (way.is_open(of_state[static_cast<std::size_t>(way.from)].rest)) return false;
  return true;
}
static_assert(every_way_is_closed_at_rest());

constexpr auto faults = []() {
  std::array<Fault, protocol::watch_table.size()> result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = protocol::watch_table[i].fault;
  return result;
}();

/// For each fault code, the check that prevents the user from clearing the fault.
constexpr auto hindrance = []() {
  std::array<Watches, protocol::fault_code_end> result{};
  for (const auto& row : protocol::watch_table)
    if (row.clearing != protocol::Clearing::at_once)
      result[static_cast<std::size_t>(row.fault)] = protocol::watch(row.fault);
  return result;
}();

}  // namespace

bool surely_stays(State state, const Situation& situation) {
  const OfState& here = of_state[static_cast<std::size_t>(state)];
  return ((situation.found & here.watched) | ((situation.events ^ here.rest) & here.moved_by)) == 0;
}

Supervisor advance(const Supervisor& supervisor, const Situation& situation) {
  const OfState& here = of_state[static_cast<std::size_t>(supervisor.state)];
  if (const Watches found = situation.found & here.watched; found != 0) [[unlikely]]
    return {State::fault, faults[static_cast<std::size_t>(std::countr_zero(found))]};
  protocol::Events now = situation.events;
  if (supervisor.state == State::fault) [[unlikely]]
    now |= protocol::when(Event::cause, (situation.found & hindrance[static_cast<std::size_t>(supervisor.fault)]) != 0);
  // A board that waits for its boot loader still stores the reported fault.
  now |= protocol::when(Event::told, supervisor.fault != Fault::none);
  for (const Way* way = here.ways_begin; way != here.ways_end; ++way)
    if (way->is_open(now))
      return {way->to, way->to == State::update || way->to == State::fault ? supervisor.fault : Fault::none};
  return supervisor;
}

}  // namespace inkwell::control
