// Each state in which the arm is not ready has a reason and a button, and each gray force button has a reason.
#include <doctest/doctest.h>

#include "host/companion/window/device_desk/next_step.hpp"

using namespace inkwell;
using namespace inkwell::window;
using protocol::State;

namespace {

DeviceView in_state(State state) {
  DeviceView view;
  view.status.connection = device::Connection::connected;
  view.pose = device::Pose{};
  view.pose->state = state;
  return view;
}

}  // namespace

TEST_CASE("every state without force except fault has a next step with a button, and a fault has a banner") {
  for (const auto& row : protocol::state_table) {
    CAPTURE(row.name);
    const auto state = static_cast<State>(&row - &protocol::state_table[0]);
    const auto step = next_step_of(in_state(state), {});
    CHECK(step.has_value() == (!protocol::force_is_on(state) && state != State::fault));
    if (!step) continue;
    CHECK_FALSE(step->title.empty());
    CHECK_FALSE(step->button.empty());
    CHECK(step->reason.empty() == (state == State::ready));
  }
}

TEST_CASE("a force without motor current has a next step, which starts the guide for the motors") {
  DeviceView view = in_state(State::limited);
  CHECK_FALSE(next_step_of(view, {}).has_value());
  view.pose->limits = static_cast<std::uint8_t>(protocol::Limit::motors) & 127u;
  const auto step = next_step_of(view, {});
  REQUIRE(step.has_value());
  CHECK(step->action == NextAction::measure_motors);
  CHECK_FALSE(step->reason.empty());
  CHECK_FALSE(next_step_of(view, {.is_replay = true}).has_value());
  view.pose->state = State::fault;
  CHECK_FALSE(next_step_of(view, {}).has_value());
}

TEST_CASE("with an unknown position, the simulated hand offers to put the stylus into the inkwell") {
  const auto simulated = next_step_of(in_state(State::unreferenced), {.has_hand = true});
  REQUIRE(simulated.has_value());
  CHECK(simulated->title == "Position unknown: put the stylus into the inkwell");
  CHECK(simulated->action == NextAction::into_inkwell);
  CHECK(simulated->button == "Into the inkwell");
  CHECK(next_step_of(in_state(State::unreferenced), {})->action == NextAction::show_guides);
}

TEST_CASE("the reason for a gray force button is known in every state, and missing only if the force can be on") {
  for (const auto& row : protocol::state_table) {
    CAPTURE(row.name);
    const auto state = static_cast<State>(&row - &protocol::state_table[0]);
    const bool can_be_on = state == State::ready || protocol::force_is_on(state);
    CHECK(why_force_waits(in_state(state), {}).empty() == can_be_on);
  }
  CHECK_FALSE(why_force_waits({}, {}).empty());
  CHECK_FALSE(why_force_waits(in_state(State::ready), {.is_replay = true}).empty());
  CHECK(why_force_waits(in_state(State::ready), {.force_waits = "A guide runs."}) == "A guide runs.");
  CHECK_FALSE(next_step_of(in_state(State::ready), {.force_waits = "A guide runs."}).has_value());
}
