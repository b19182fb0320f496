// Compares the supervisor's tables with a separate copy in this file.
#include <doctest/doctest.h>

#include <cstdint>
#include <type_traits>
#include <vector>

#include "firmware/control/supervision/supervisor.hpp"

namespace {

using namespace inkwell;
using control::advance;
using control::Situation;
using control::Supervisor;
using protocol::condition;
using protocol::Event;
using protocol::Events;
using protocol::events;
using protocol::Fault;
using protocol::State;

template <class First, class Second>
concept Situates = requires {
  Situation{First(), Second()};
};
static_assert(Situates<Events, protocol::Conditions>);
static_assert(!Situates<protocol::Conditions, Events>);
static_assert(!Situates<std::uint32_t, protocol::Conditions> && !Situates<Events, std::uint32_t>);
static_assert(!std::is_constructible_v<Events, protocol::Conditions>);
static_assert(!std::is_constructible_v<protocol::Conditions, Events>);

constexpr Events good = events(Event::measured, Event::tested, Event::referenced);

Supervisor in(State state) { return {state, Fault::none}; }
State next(State state, Events now) { return advance(in(state), {now, {}}).state; }
Supervisor faulty(Fault fault) { return {State::fault, fault}; }

TEST_CASE("a fault without a row in the condition table has the index after the last row") {
  CHECK(protocol::index_of(Fault::none) == protocol::condition_table.size());
  CHECK(protocol::index_of(static_cast<Fault>(protocol::fault_code_end)) == protocol::condition_table.size());
}

TEST_CASE("the states lead from power-up to force") {
  CHECK(next(State::starting, events(Event::enable)) == State::starting);
  CHECK(next(State::starting, events(Event::enable, Event::measured)) == State::testing);
  CHECK(next(State::testing, events(Event::enable, Event::measured)) == State::testing);
  CHECK(next(State::testing, events(Event::enable, Event::measured, Event::tested)) == State::unreferenced);
  CHECK(next(State::unreferenced, events(Event::enable, Event::measured, Event::tested)) == State::unreferenced);
  CHECK(next(State::unreferenced, good) == State::ready);
  CHECK(next(State::ready, good) == State::ready);
  CHECK(next(State::ready, good | events(Event::enable)) == State::ramping);
  CHECK(next(State::ramping, good) == State::ramping);
  CHECK(next(State::ramping, good | events(Event::risen)) == State::active);
  CHECK(next(State::active, good | events(Event::risen)) == State::active);
}

TEST_CASE("the state is limited only after the force has risen, and only while a limit is reached") {
  CHECK(next(State::ramping, good | events(Event::held_back)) == State::ramping);
  CHECK(next(State::active, good | events(Event::risen, Event::held_back)) == State::limited);
  CHECK(next(State::limited, good | events(Event::risen, Event::held_back)) == State::limited);
  CHECK(next(State::limited, good | events(Event::risen)) == State::active);
}

TEST_CASE("stop leads to ready and disable to landing from every state with a force, despite other events") {
  for (const State state : {State::ready, State::ramping, State::active, State::limited, State::landing})
    for (const Events also :
         {Events(), events(Event::enable), events(Event::risen), events(Event::risen, Event::held_back)}) {
      CHECK(next(state, good | events(Event::disable) | also) == (state == State::ready ? state : State::landing));
      CHECK(next(state, good | events(Event::stop) | also) == State::ready);
      CHECK(next(state, good | events(Event::stop, Event::disable) | also) == State::ready);
    }
}

TEST_CASE("a landing ends in ready, or in a new rise") {
  CHECK(next(State::landing, good) == State::landing);
  CHECK(next(State::landing, good | events(Event::landed)) == State::ready);
  CHECK(next(State::landing, good | events(Event::enable)) == State::ramping);
  CHECK(next(State::ramping, good | events(Event::landed)) == State::ramping);
}

TEST_CASE("a lost reference leads back to the state unreferenced") {
  CHECK(next(State::ready, events(Event::measured, Event::enable)) == State::unreferenced);
}

TEST_CASE("a test on command begins while the force is off, and in a fault only before one has passed") {
  const Events asked = good | events(Event::self_test);
  CHECK(next(State::unreferenced, events(Event::measured, Event::tested, Event::self_test)) == State::testing);
  CHECK(next(State::ready, asked) == State::testing);
  for (const State state : {State::ramping, State::active, State::limited, State::update})
    CHECK(next(state, asked) != State::testing);
  const Supervisor failed = faulty(Fault::self_test_failed);
  const Events untested = events(Event::measured, Event::referenced, Event::self_test);
  CHECK(advance(failed, {untested, {}}) == in(State::testing));
  CHECK(advance(faulty(Fault::supply_low), {untested, condition(Fault::supply_low)}) == faulty(Fault::supply_low));
  CHECK(advance(faulty(Fault::over_speed), {asked, {}}) == faulty(Fault::over_speed));
  CHECK(advance(failed, {events(Event::referenced, Event::self_test), {}}) == failed);
}

TEST_CASE("for the boot loader every state is left, and the device is where it was if the host thinks better of it") {
  for (const State state : {State::starting, State::testing, State::unreferenced, State::ready, State::ramping,
                            State::active, State::limited, State::landing, State::fault, State::update}) {
    CHECK(next(state, good | events(Event::update)) == State::update);
    CHECK(next(state, good | events(Event::update, Event::enable, Event::clear)) == State::update);
  }
  CHECK(next(State::update, {}) == State::starting);
  CHECK(next(State::update, events(Event::measured)) == State::testing);
  CHECK(next(State::update, events(Event::measured, Event::tested)) == State::unreferenced);
  CHECK(next(State::update, good) == State::ready);
}

TEST_CASE("the boot loader takes no fault away: it is there again if the device stays") {
  for (const auto& row : protocol::fault_table) {
    const auto fault = static_cast<Fault>(row.code);
    if (fault == Fault::none) continue;
    CAPTURE(row.name);
    const Supervisor leaving = advance(faulty(fault), {good | events(Event::update), {}});
    CHECK(leaving == Supervisor{State::update, fault});
    CHECK(advance(leaving, {good | events(Event::update, Event::clear), {}}) == leaving);
    for (const Events now : {Events(), events(Event::measured), events(Event::measured, Event::tested), good})
      CHECK(advance(leaving, {now, {}}) == faulty(fault));
  }
}

struct FaultCase {
  Fault fault;
  std::vector<State> monitored_in;
  bool clears_at_once;
};

std::vector<FaultCase> fault_cases() {
  const std::vector<State> driven{State::ramping, State::active, State::limited};
  const std::vector<State> force{State::ramping, State::active, State::limited, State::landing};
  const std::vector<State> moving{State::ready, State::ramping, State::active, State::limited, State::landing};
  const std::vector<State> started{State::testing, State::unreferenced, State::ready,  State::ramping,
                                   State::active,  State::limited,      State::landing};
  const std::vector<State> all{State::starting, State::testing, State::unreferenced, State::ready,
                               State::ramping,  State::active,  State::limited,      State::landing};
  return {{Fault::memory_damaged, all, false},
          {Fault::crystal_failed, all, true},
          {Fault::processor_fault, all, true},
          {Fault::watchdog, all, true},
          {Fault::servo_overrun, all, true},
          {Fault::heartbeat_missed, all, true},
          {Fault::main_loop_stalled, started, true},
          {Fault::not_finite, all, false},
          {Fault::force_law, all, true},
          {Fault::current_sensor, all, false},
          {Fault::samples_stale, started, false},
          {Fault::supply_low, started, false},
          {Fault::supply_high, started, false},
          {Fault::bridge_fault, started, false},
          {Fault::over_current, started, false},
          {Fault::current_jump, force, true},
          {Fault::motor_implausible, force, true},
          {Fault::motor_hot, started, false},
          {Fault::encoder_implausible, moving, true},
          {Fault::over_speed, force, true},
          {Fault::host_silent, driven, true},
          {Fault::usb_gone, driven, true},
          {Fault::logic_supply_low, all, false},
          {Fault::supply_ripple, started, false},
          {Fault::encoder_wire, moving, true},
          {Fault::bridge_wire, all, false},
          {Fault::analog_supply, all, false},
          {Fault::self_test_failed, {State::testing}, false},
          {Fault::inkwell_implausible, moving, true}};
}

TEST_CASE("each fault is looked for in its states and in no other") {
  CHECK(fault_cases().size() + 1 == protocol::fault_table.size());
  for (const FaultCase& row : fault_cases())
    for (const State state : {State::starting, State::testing, State::unreferenced, State::ready, State::active,
                              State::ramping, State::limited, State::landing, State::update}) {
      CAPTURE(static_cast<int>(row.fault));
      CAPTURE(static_cast<int>(state));
      Events now = good;
      if (state == State::starting) now = {};
      if (state == State::testing) now = events(Event::measured);
      if (state == State::unreferenced) now = events(Event::measured, Event::tested);
      if (state == State::limited) now |= events(Event::held_back);
      if (state == State::update) now |= events(Event::update);
      bool expected = false;
      for (const State monitored : row.monitored_in) expected |= monitored == state;
      CHECK(advance(in(state), {now, condition(row.fault)}) == (expected ? faulty(row.fault) : in(state)));
    }
}

TEST_CASE("a fault remains until it is cleared, and can be cleared only after its cause has disappeared") {
  const Events clear = good | events(Event::clear);
  for (const FaultCase& row : fault_cases()) {
    CAPTURE(static_cast<int>(row.fault));
    const Supervisor found = faulty(row.fault);
    CHECK(advance(found, {good, {}}) == found);
    CHECK(advance(found, {good | events(Event::enable), {}}) == found);
    CHECK(advance(found, {clear, {}}) == in(State::ready));
    CHECK(advance(found, {clear, condition(row.fault)}) == (row.clears_at_once ? in(State::ready) : found));
    // A fault can be cleared while the condition of another fault is true. After the first fault is cleared, the
    // condition of the second fault raises the second fault.
    const Fault other = row.fault == Fault::supply_low ? Fault::supply_high : Fault::supply_low;
    CHECK(advance(found, {clear, condition(other)}) == in(State::ready));
  }
}

TEST_CASE("the reference of the arm is void after faults that an encoder may have brought about, and after no other") {
  for (const FaultCase& row : fault_cases()) {
    CAPTURE(static_cast<int>(row.fault));
    CHECK((protocol::voiding_conditions & condition(row.fault)).any() ==
          (row.fault == Fault::encoder_implausible || row.fault == Fault::encoder_wire ||
           row.fault == Fault::motor_implausible || row.fault == Fault::inkwell_implausible));
  }
}

TEST_CASE("where a cleared fault leads to") {
  const Supervisor found = faulty(Fault::processor_fault);
  CHECK(advance(found, {events(Event::clear), {}}) == in(State::starting));
  CHECK(advance(found, {events(Event::clear, Event::measured), {}}) == in(State::testing));
  CHECK(advance(found, {events(Event::clear, Event::measured, Event::tested), {}}) == in(State::unreferenced));
  CHECK(advance(found, {good | events(Event::clear), {}}) == in(State::ready));
}

TEST_CASE("of several faults the one that explains the others is shown, and the first one stays") {
  const auto several = condition(Fault::supply_low) | condition(Fault::bridge_fault) | condition(Fault::over_current) |
                       condition(Fault::host_silent);
  CHECK(advance(in(State::active), {good, several}).fault == Fault::supply_low);
  CHECK(advance(in(State::active), {good, several | condition(Fault::servo_overrun)}).fault == Fault::servo_overrun);
  CHECK(advance(in(State::active), {good | events(Event::update, Event::disable), several}).fault == Fault::supply_low);
  const Supervisor first = faulty(Fault::over_speed);
  CHECK(advance(first, {good, several | condition(Fault::servo_overrun)}) == first);
}

TEST_CASE("stays_unchanged returns true only for a state that the tables do not leave") {
  int stays = 0;
  for (std::size_t i = 0; i < protocol::state_count; ++i)
    for (std::uint32_t bits = 0; bits < 2u * events(Event::self_test).bits(); ++bits)
      for (const auto found : {protocol::Conditions(), condition(Fault::over_speed), condition(Fault::supply_low),
                               condition(Fault::crystal_failed)}) {
        const Events now(bits);
        const Supervisor here{static_cast<State>(i), Fault::none};
        if (!control::stays_unchanged(here.state, {now, found})) continue;
        ++stays;
        CHECK(advance(here, {now, found}) == here);
      }
  CHECK(stays > 1'000);
  CHECK(control::stays_unchanged(State::active, {good | events(Event::risen), {}}));
  CHECK(control::stays_unchanged(State::limited, {good | events(Event::risen, Event::held_back), {}}));
}

}  // namespace
