// Every cell of the supervisor's tables.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include <control/supervisor.hpp>

namespace {

using namespace inkwell;
using control::advance;
using control::Conditions;
using control::Requests;
using control::Supervisor;
using protocol::Fault;
using protocol::State;

constexpr Conditions good{.offsets_measured = true, .referenced = true};

Supervisor in(State state) { return {state, Fault::none}; }

TEST_CASE("the way from power-up to force") {
  Conditions conditions;
  Requests enable{.enable_force = true};
  CHECK(advance(in(State::starting), conditions, enable) == in(State::starting));
  conditions.offsets_measured = true;
  CHECK(advance(in(State::starting), conditions, enable) == in(State::unreferenced));
  CHECK(advance(in(State::unreferenced), conditions, enable) == in(State::unreferenced));
  conditions.referenced = true;
  CHECK(advance(in(State::unreferenced), conditions, enable) == in(State::ready));
  CHECK(advance(in(State::ready), conditions, {}) == in(State::ready));
  CHECK(advance(in(State::ready), conditions, enable) == in(State::active));
  CHECK(advance(in(State::active), conditions, {}) == in(State::active));
  CHECK(advance(in(State::active), conditions, {.disable_force = true}) == in(State::ready));
}

TEST_CASE("to disable wins over to enable") {
  const Requests both{.enable_force = true, .disable_force = true};
  CHECK(advance(in(State::ready), good, both) == in(State::ready));
  CHECK(advance(in(State::active), good, both) == in(State::ready));
}

struct FaultCase {
  Fault fault;
  bool Conditions::*condition;
  std::vector<State> looked_for_in;
  bool clears_at_once;
};

std::vector<FaultCase> fault_cases() {
  const std::vector<State> started{State::unreferenced, State::ready, State::active};
  const std::vector<State> all{State::starting, State::unreferenced, State::ready, State::active};
  return {{Fault::not_finite, &Conditions::not_finite, all, false},
          {Fault::supply_low, &Conditions::supply_low, started, false},
          {Fault::supply_high, &Conditions::supply_high, started, false},
          {Fault::samples_stale, &Conditions::samples_stale, started, false},
          {Fault::bridge_fault, &Conditions::bridge_fault, started, false},
          {Fault::over_current, &Conditions::over_current, started, false},
          {Fault::motor_hot, &Conditions::motor_hot, started, false},
          {Fault::encoder_implausible, &Conditions::encoder_implausible, {State::ready, State::active}, true},
          {Fault::over_speed, &Conditions::over_speed, {State::active}, true},
          {Fault::host_silent, &Conditions::host_silent, {State::active}, true}};
}

TEST_CASE("each fault is looked for in its states and in no other") {
  for (const FaultCase& row : fault_cases())
    for (const State state : {State::starting, State::unreferenced, State::ready, State::active}) {
      CAPTURE(static_cast<int>(row.fault));
      CAPTURE(static_cast<int>(state));
      Conditions conditions{.offsets_measured = state != State::starting,
                            .referenced = state == State::ready || state == State::active};
      conditions.*row.condition = true;
      const bool expected =
          std::find(row.looked_for_in.begin(), row.looked_for_in.end(), state) != row.looked_for_in.end();
      CHECK(advance(in(state), conditions, {}) == (expected ? Supervisor{State::fault, row.fault} : in(state)));
    }
}

TEST_CASE("a fault stays until it is cleared, and is cleared only when its cause is gone") {
  for (const FaultCase& row : fault_cases()) {
    CAPTURE(static_cast<int>(row.fault));
    const Supervisor faulty{State::fault, row.fault};
    CHECK(advance(faulty, good, {}) == faulty);
    CHECK(advance(faulty, good, {.enable_force = true}) == faulty);
    CHECK(advance(faulty, good, {.clear_fault = true}) == in(State::ready));
    Conditions present = good;
    present.*row.condition = true;
    CHECK(advance(faulty, present, {.clear_fault = true}) == (row.clears_at_once ? in(State::ready) : faulty));
  }
}

TEST_CASE("a broken current sensor is found when the offsets are known and can not be cleared") {
  const Conditions broken{.offsets_measured = true, .offsets_plausible = false, .referenced = true};
  const Supervisor faulty{State::fault, Fault::current_sensor};
  CHECK(advance(in(State::starting), broken, {}) == faulty);
  CHECK(advance(faulty, broken, {.clear_fault = true}) == faulty);
  const Conditions not_yet_known{.offsets_measured = false, .offsets_plausible = false};
  CHECK(advance(in(State::starting), not_yet_known, {}) == in(State::starting));
}

TEST_CASE("where a cleared fault leads to") {
  const Supervisor faulty{State::fault, Fault::processor_fault};
  const Requests clear{.clear_fault = true};
  CHECK(advance(faulty, {}, clear) == in(State::starting));
  CHECK(advance(faulty, {.offsets_measured = true}, clear) == in(State::unreferenced));
  CHECK(advance(faulty, good, clear) == in(State::ready));
}

TEST_CASE("of several faults the one that explains the others is shown, and the first one stays") {
  Conditions several = good;
  several.supply_low = several.bridge_fault = several.over_current = several.host_silent = true;
  CHECK(advance(in(State::active), several, {}).fault == Fault::supply_low);
  CHECK(advance(in(State::active), several, {.raised = Fault::servo_overrun}).fault == Fault::servo_overrun);
  const Supervisor first{State::fault, Fault::over_speed};
  CHECK(advance(first, several, {.raised = Fault::servo_overrun}) == first);
}

}  // namespace
