// Supervisor of the board, in three tables: states, transitions, and the monitored faults of each state. The firmware
// uses the tables (supervisor.hpp), and `inkwell reference` prints them. Firmware tests cover every cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/bit_set.hpp"
#include "protocol/faults.hpp"

namespace inkwell::protocol {

// ---- states ------------------------------------------------------------------------------------------------

// clang-format off
/// X(id, name, true if the hand feels a force, meaning)
#define INKWELL_STATES(X)                                                                                          \
  X(0, starting, false, "The board measures the offsets of its current sensors. This takes 0.1 s.")                 \
  X(1, unreferenced, false, "The arm position is not known. Put the stylus into the inkwell once. If the stylus is in the inkwell, take it out first.") \
  X(2, ready, false, "The pose is valid. The force is off.")                                                       \
  X(3, active, true, "The pose is valid. The force is on.")                                                        \
  X(4, fault, false, "The motors are off because of the fault shown.")                                             \
  X(5, ramping, true, "The pose is valid. The force is on and rises to its full value.")                        \
  X(6, limited, true, "The pose is valid. The force is on, and a limit reduces it.")                            \
  X(7, update, false, "The motors are off. The board is about to start its boot loader.")                          \
  X(8, landing, true, "The pose is valid. The force falls to zero.") \
  X(9, testing, false, "The self-test runs, with short pulses on the motors. Hold the arm still.")
// clang-format on

/// State of the supervisor.
enum class State : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_STATES(X)
#undef X
};

struct StateInfo {
  std::string_view name;
  bool force_is_on;
  std::string_view meaning;
};

inline constexpr auto state_table = std::to_array<StateInfo>({
#define X(id, name, force_is_on, meaning) {#name, force_is_on, meaning},
    INKWELL_STATES(X)
#undef X
});
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

/// Uses a bit mask instead of the table, because the control interrupt calls this function.
constexpr bool force_is_on(State state) { return with_force.contains(state); }

// ---- transitions -------------------------------------------------------------------------------------------

// clang-format off
/// X(bit, name, meaning)
#define INKWELL_EVENTS(X)                                                             \
  X(1, measured, "the offsets of the current sensors are known")                      \
  X(2, referenced, "the arm position is known, because the stylus was in the inkwell")                            \
  X(4, enable, "the command enable_force was received")                                       \
  X(8, disable, "the command disable_force was received")                                     \
  X(16, clear, "the command clear_fault was received")                                        \
  X(32, cause, "the cause of the fault is still present")                                    \
  X(64, risen, "the force has risen to its full value")                            \
  X(128, held_back, "a limit reduces the force")                                   \
  X(256, update, "the host has requested the boot loader and has not reset the bus since") \
  X(512, stop, "the command stop was received, or the USB connection was lost")                          \
  X(1024, landed, "the force has fallen to zero") \
  X(2048, tested, "the self-test has ended without a failure that prevents the force") \
  X(4096, self_test, "the command self_test was received") \
  X(8192, raised, "an earlier fault has not been cleared")
// clang-format on

/// Inputs of the supervisor's decisions.
enum class Event : std::uint16_t {
#define X(bit, name, ...) name = bit,
  INKWELL_EVENTS(X)
#undef X
};

struct EventInfo {
  Event event;
  std::string_view name;
  std::string_view meaning;
};

inline constexpr auto event_table = std::to_array<EventInfo>({
#define X(bit, name, meaning) {Event::name, #name, meaning},
    INKWELL_EVENTS(X)
#undef X
});

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

/// Rows with the same `from` are consecutive, and the supervisor follows the first open transition among them. A fault
/// has precedence and leads to `fault` from each state except `fault` and `update`.
inline constexpr auto transition_table = std::to_array<StateTransition>({
    {State::starting, State::update, events(Event::update), {}},
    {State::starting, State::testing, events(Event::measured), {}},
    {State::testing, State::update, events(Event::update), {}},
    {State::testing, State::unreferenced, events(Event::tested), {}},
    {State::unreferenced, State::update, events(Event::update), {}},
    {State::unreferenced, State::testing, events(Event::self_test), {}},
    {State::unreferenced, State::ready, events(Event::referenced), {}},
    {State::ready, State::update, events(Event::update), {}},
    {State::ready, State::unreferenced, {}, events(Event::referenced)},
    {State::ready, State::testing, events(Event::self_test), {}},
    {State::ready, State::ramping, events(Event::enable), events(Event::disable, Event::stop)},
    {State::ramping, State::update, events(Event::update), {}},
    {State::ramping, State::ready, events(Event::stop), {}},
    {State::ramping, State::landing, events(Event::disable), {}},
    {State::ramping, State::active, events(Event::risen), {}},
    {State::active, State::update, events(Event::update), {}},
    {State::active, State::ready, events(Event::stop), {}},
    {State::active, State::landing, events(Event::disable), {}},
    {State::active, State::limited, events(Event::held_back), {}},
    {State::limited, State::update, events(Event::update), {}},
    {State::limited, State::ready, events(Event::stop), {}},
    {State::limited, State::landing, events(Event::disable), {}},
    {State::limited, State::active, {}, events(Event::held_back)},
    {State::landing, State::update, events(Event::update), {}},
    {State::landing, State::ready, events(Event::stop), {}},
    {State::landing, State::ramping, events(Event::enable), events(Event::disable)},
    {State::landing, State::ready, events(Event::landed), {}},
    {State::fault, State::update, events(Event::update), {}},
    {State::fault, State::starting, events(Event::clear), events(Event::cause, Event::measured)},
    {State::fault, State::testing, events(Event::clear, Event::measured), events(Event::cause, Event::tested)},
    {State::fault, State::testing, events(Event::self_test, Event::measured), events(Event::cause, Event::tested)},
    {State::fault, State::unreferenced, events(Event::clear, Event::tested), events(Event::cause, Event::referenced)},
    {State::fault, State::ready, events(Event::clear, Event::tested, Event::referenced), events(Event::cause)},
    {State::update, State::fault, events(Event::raised), events(Event::update)},
    {State::update, State::starting, {}, events(Event::update, Event::measured)},
    {State::update, State::testing, events(Event::measured), events(Event::update, Event::tested)},
    {State::update, State::unreferenced, events(Event::tested), events(Event::update, Event::referenced)},
    {State::update, State::ready, events(Event::tested, Event::referenced), events(Event::update)},
});

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
  /// The low-side switches are on, and the back EMF brakes the motors until the probe is slow. If a motor current
  /// exceeds the current for the force limit, the bridges are off for one period.
  brake,
  /// Like `brake`, but with a lower current threshold, because the hand may continue its motion.
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

/// If several faults occur in one period, the board reports the fault with the first row in this table. In the
/// table, a fault precedes the faults that it explains. The reported fault remains until it is cleared.
inline constexpr auto condition_table = []() {
  constexpr States moving = States(State::ready) | with_force;
  constexpr States driven{State::ramping, State::active, State::limited};
  constexpr States started = States(State::testing, State::unreferenced) | moving;
  constexpr States every = States(State::starting) | started;
  using enum Clearing;
  using enum Off;
  return std::to_array<Condition>({
      {Fault::memory_damaged, every, by_reset, coast},
      {Fault::crystal_failed, every, at_once, coast},
      {Fault::processor_fault, every, at_once, coast},
      {Fault::watchdog, every, at_once, coast},
      {Fault::servo_overrun, every, at_once, coast},
      {Fault::heartbeat_missed, every, at_once, coast},
      // The main loop is not monitored in `starting`, because the control interrupt starts first.
      {Fault::main_loop_stalled, started, at_once, coast},
      {Fault::not_finite, every, when_gone, coast},
      {Fault::force_law, every, at_once, brake},
      {Fault::logic_supply_low, every, when_gone, coast},
      {Fault::analog_supply, every, when_gone, coast},
      {Fault::bridge_wire, every, when_gone, coast},
      {Fault::current_sensor, every, when_gone, coast},
      {Fault::samples_stale, started, when_gone, coast},
      {Fault::supply_low, started, when_gone, coast},
      {Fault::supply_high, started, when_gone, coast},
      {Fault::supply_ripple, started, when_gone, coast},
      {Fault::bridge_fault, started, when_gone, coast},
      {Fault::over_current, started, when_gone, coast},
      {Fault::self_test_failed, State::testing, when_gone, coast},
      {Fault::current_jump, with_force, at_once, coast},
      {Fault::motor_implausible, with_force, at_once, coast, true},
      {Fault::motor_hot, started, when_gone, coast},
      {Fault::encoder_wire, moving, at_once, coast, true},
      {Fault::encoder_implausible, moving, at_once, coast, true},
      {Fault::inkwell_implausible, moving, at_once, coast, true},
      {Fault::over_speed, with_force, at_once, brake},
      {Fault::usb_gone, driven, at_once, brake_gently},
      {Fault::host_silent, driven, at_once, brake_gently},
  });
}();

/// Set of rows of condition_table, as one bit per row. Bit 0 is the first row.
using Conditions = BitSet<Condition>;
static_assert(condition_table.size() <= 32);

namespace detail {
/// Index of each fault code in condition_table. The indices are stored, because the compiler does not evaluate a search
/// in a long table at compile time.
inline constexpr auto places = []() {
  std::array<std::uint8_t, fault_code_end> result{};
  result.fill(static_cast<std::uint8_t>(condition_table.size()));
  for (std::size_t i = 0; i < condition_table.size(); ++i)
    result[static_cast<std::size_t>(condition_table[i].fault)] = static_cast<std::uint8_t>(i);
  return result;
}();
}  // namespace detail

/// Returns the index of a fault in condition_table.
constexpr std::size_t place_of(Fault fault) {
  const auto code = static_cast<std::size_t>(fault);
  return code < detail::places.size() ? detail::places[code] : condition_table.size();
}
constexpr Conditions condition(Fault fault) { return Conditions(1u << place_of(fault)); }
constexpr Conditions condition(Fault fault, bool is_found) {
  return Conditions(static_cast<std::uint32_t>(is_found) << place_of(fault));
}

/// Returns the set of rows for which `is_so` returns true.
template <class Predicate>
constexpr Conditions conditions(Predicate is_so) {
  Conditions bits;
  for (std::size_t i = 0; i < condition_table.size(); ++i)
    if (is_so(condition_table[i])) bits |= Conditions(1u << i);
  return bits;
}

/// These faults invalidate the reference in every state, even if another fault is reported.
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
#define X(id, text, ...) \
  static_assert(state_table[id].name == std::string_view(#text), #text ": the id must be the row index");
INKWELL_STATES(X)
#undef X
}  // namespace detail

static_assert(detail::every_fault_has_one_condition(),
              "condition_table: each fault except `none` needs exactly one row");
static_assert(detail::transitions_are_grouped(),
              "transition_table: the transitions from one state must be consecutive");

}  // namespace inkwell::protocol
