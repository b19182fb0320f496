// States, transitions and monitored faults, from protocol/tables/supervision.toml. The firmware's supervisor uses the
// tables. Firmware tests cover every cell of the tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/bit_set.hpp"
#include "protocol/faults.hpp"

namespace inkwell::protocol {

// ---- states ------------------------------------------------------------------------------------------------

enum class State : std::uint8_t;
enum class Event : std::uint16_t;

struct StateInfo {
  std::string_view name;
  bool force_is_on;
  const char* meaning;
};

struct EventInfo {
  Event event;
  std::string_view name;
  const char* meaning;
};

}  // namespace inkwell::protocol

#include <tables/supervision.hpp>  // State, state_table, Event, event_table

namespace inkwell::protocol {

inline constexpr std::size_t state_count = state_table.size();

inline constexpr StateInfo unknown_state{"unknown", false,
                                         "The device is in a state that is unknown to this companion."};

constexpr const StateInfo& info(State state) {
  const auto index = static_cast<std::size_t>(state);
  return index < state_count ? state_table[index] : unknown_state;
}

/// Set of states, as one bit per state.
class States {
 public:
  constexpr States() = default;
  template <class... More>
  constexpr States(State first, More... more) : bits_((bit(first) | ... | bit(more))) {}
  constexpr bool contains(State state) const {
    return static_cast<std::size_t>(state) < state_count && (bits_ & bit(state)) != 0;
  }
  constexpr States operator|(States other) const {
    States both;
    both.bits_ = bits_ | other.bits_;
    return both;
  }

 private:
  static constexpr std::uint32_t bit(State state) { return 1u << static_cast<unsigned>(state); }
  std::uint32_t bits_ = 0;
};

inline constexpr States with_force = []() {
  States states;
  for (std::size_t i = 0; i < state_count; ++i)
    if (state_table[i].force_is_on) states = states | States(static_cast<State>(i));
  return states;
}();

/// In the control interrupt, a bit mask is faster than a table look-up.
constexpr bool force_is_on(State state) { return with_force.contains(state); }

// ---- transitions -------------------------------------------------------------------------------------------

/// Set of events, as one bit per event.
using Events = BitSet<Event>;
template <class... More>
constexpr Events events(More... some) {
  return Events((0u | ... | static_cast<std::uint32_t>(some)));
}
constexpr Events when(Event event, bool is_so) { return is_so ? events(event) : Events(); }

/// State transition. A transition is open if all events of `needs` and no event of `unless` are present.
struct StateTransition {
  State from;
  State to;
  Events needs;
  Events unless;
  constexpr bool is_open(Events now) const { return (now & (needs | unless)) == needs; }
};

// ---- monitored faults --------------------------------------------------------------------------------------

/// Condition for clearing a fault.
enum class Clearing : std::uint8_t {
  when_gone,  ///< after its cause is gone
  at_once,    ///< at any time: the cause was a single event, or cannot be measured while the motors are off
  by_reset,   ///< only by a reset: the firmware cannot remove the cause
};

/// Method by which a fault switches the motors off.
enum class Off : std::uint8_t {
  coast,  ///< bridges off: for faults that make currents, bridges, supply or speed unreliable
  /// The low-side switches short the motors until the probe is slow. A motor current above the current for the force
  /// limit switches the bridges off for one period.
  brake,
  /// The current threshold is lower than for `brake`, because the hand may continue to move.
  brake_gently,
};

struct Condition {
  Fault fault;
  States monitored_in;
  Clearing clearing;
  Off off;
  /// Counts may be lost. The position of the arm is unknown until the stylus is in the inkwell again.
  bool voids_reference = false;
};

}  // namespace inkwell::protocol

#include <tables/monitoring.hpp>  // transition_table, condition_table

namespace inkwell::protocol {

/// Set of rows of condition_table, as one bit per row. Bit 0 is the first row.
using Conditions = BitSet<Condition>;
static_assert(condition_table.size() <= 32);

namespace detail {
/// Index of each fault code in condition_table. The compiler does not evaluate a search in a long table at compile
/// time.
inline constexpr auto indices = []() {
  std::array<std::uint8_t, fault_code_end> result{};
  result.fill(static_cast<std::uint8_t>(condition_table.size()));
  for (std::size_t i = 0; i < condition_table.size(); ++i)
    result[static_cast<std::size_t>(condition_table[i].fault)] = static_cast<std::uint8_t>(i);
  return result;
}();
}  // namespace detail

/// Returns the index of a fault in condition_table.
constexpr std::size_t index_of(Fault fault) {
  const auto code = static_cast<std::size_t>(fault);
  return code < detail::indices.size() ? detail::indices[code] : condition_table.size();
}
constexpr Conditions condition(Fault fault) { return Conditions(1u << index_of(fault)); }
constexpr Conditions condition(Fault fault, bool is_found) {
  return Conditions(static_cast<std::uint32_t>(is_found) << index_of(fault));
}

/// Returns the set of rows for which `is_so` returns true.
template <class Predicate>
constexpr Conditions conditions(Predicate is_so) {
  Conditions bits;
  for (std::size_t i = 0; i < condition_table.size(); ++i)
    if (is_so(condition_table[i])) bits |= Conditions(1u << i);
  return bits;
}

/// Faults that invalidate the reference in every state, regardless of other faults.
inline constexpr Conditions voiding_conditions = conditions([](const Condition& row) { return row.voids_reference; });

// ---- consistency of the tables -----------------------------------------------------------------------------

namespace detail {
constexpr bool every_fault_has_one_condition() {
  for (const auto& row : fault_table) {
    std::size_t rows = 0;
    for (const Condition& condition : condition_table) rows += static_cast<std::uint16_t>(condition.fault) == row.code;
    if (rows != (row.code == 0 ? 0u : 1u)) return false;
  }
  return true;
}
constexpr bool transitions_are_grouped() {
  for (std::size_t i = 1; i < transition_table.size(); ++i)
    for (std::size_t k = 0; k + 1 < i; ++k)
      if (transition_table[k].from == transition_table[i].from &&
          transition_table[i - 1].from != transition_table[i].from)
        return false;
  return true;
}
}  // namespace detail

static_assert(detail::every_fault_has_one_condition(),
              "condition_table: each fault except `none` needs exactly one row");
static_assert(detail::transitions_are_grouped(),
              "transition_table: the transitions from one state must be consecutive");

}  // namespace inkwell::protocol
