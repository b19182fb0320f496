// The controller's way through its states: what is told while the force rises and is held back, what becomes of the
// motors when it goes.
#include <doctest/doctest.h>

#include "arms.hpp"
#include "simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::Controller;
using control::Samples;
using control::Settings;
using protocol::Command;
using protocol::Fault;
using protocol::State;
using enum protocol::Parameter;

constexpr int ramp_periods = 2'000;

protocol::ParameterSet parameters() {
  protocol::ParameterSet set = tests::without_motors(tests::paper_parameters());
  set[force_ramp_s] = ramp_periods * protocol::servo_period_s;
  set[host_timeout_s] = 2.0f;
  return set;
}

/// A box far from the arm: its walls ask for more force than the limit allows.
Settings held_back() {
  protocol::ParameterSet set = parameters();
  set[box_minimum_x_m] = set[box_minimum_y_m] = set[box_minimum_z_m] = 0.4f;
  set[box_maximum_x_m] = set[box_maximum_y_m] = set[box_maximum_z_m] = 0.5f;
  return control::prepare(set);
}

/// Nothing is touched.
Settings free_space() {
  protocol::ParameterSet set = parameters();
  set[wall_stiffness_N_per_m] = set[wall_damping_Ns_per_m] = 0.0f;
  return control::prepare(set);
}

TEST_CASE("the force rises, is there, is held back and free again, without a period off between them") {
  const Settings free = free_space();
  const Settings pushed = held_back();
  const Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(free);
  CHECK(controller.state() == State::ramping);
  CHECK(tests::run(controller, samples, free, ramp_periods - 2).enabled);
  CHECK(controller.state() == State::ramping);
  const auto step_to = [&](State state, const Settings& settings) {
    int periods = 0;
    for (; controller.state() != state && periods < 3'000; ++periods)
      CHECK(tests::run(controller, samples, settings, 1).enabled);
    CHECK(controller.state() == state);
    CHECK(tests::run(controller, samples, settings, 1).enabled);
  };
  step_to(State::active, free);
  controller.settings_changed();
  step_to(State::limited, pushed);
  controller.settings_changed();
  step_to(State::active, free);
  controller.carry_out(tests::command(Command::disable_force));
  CHECK_FALSE(tests::run(controller, samples, free, 1).enabled);
  CHECK(controller.state() == State::ready);
}

TEST_CASE("while the force rises a limit is not told") {
  const Settings pushed = held_back();
  Controller controller = tests::active_controller(pushed);
  tests::run(controller, tests::samples_at_rest(), pushed, ramp_periods / 2);
  CHECK(controller.limits() != 0);
  CHECK(controller.state() == State::ramping);
}

/// Spins the waist until the probe is faster than its limit.
control::Drive let_loose(Controller& controller, Samples& samples, const Settings& settings) {
  control::Drive drive;
  for (int i = 0; i < 60 && controller.state() != State::fault; ++i) {
    samples.encoder_counts[0] += 8;  // three times the speed limit
    drive = tests::run(controller, samples, settings, 1);
  }
  REQUIRE(controller.fault() == Fault::over_speed);
  return drive;
}

TEST_CASE("an arm that is let loose is braked from the same period on, until it rests") {
  const Settings settings = free_space();
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  const control::Drive drive = let_loose(controller, samples, settings);
  CHECK_FALSE(drive.enabled);
  CHECK(drive.brake);
  CHECK(tests::run(controller, samples, settings, 1).brake);
  CHECK_FALSE(tests::run(controller, samples, settings, 1'000).brake);
}

TEST_CASE("the brake ends with the fault, and with a bridge that cannot be trusted") {
  const Settings settings = free_space();
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  let_loose(controller, samples, settings);
  Controller other = controller;
  controller.carry_out(tests::command(Command::clear_fault));
  CHECK_FALSE(tests::run(controller, samples, settings, 1).brake);
  CHECK(controller.state() == State::ready);
  samples.bridge_fault = true;
  CHECK_FALSE(tests::run(other, samples, settings, 1).brake);
}

TEST_CASE("no force comes on while the board leaves for its boot loader, and it goes if it was on") {
  const Settings settings = free_space();
  const Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  tests::run(controller, samples, settings, 10);
  controller.leave_for_update();
  CHECK_FALSE(tests::run(controller, samples, settings, 1).enabled);
  CHECK(controller.state() == State::update);
  controller.leave_for_update();
  controller.carry_out(tests::command(Command::enable_force));
  CHECK_FALSE(tests::run(controller, samples, settings, 1).enabled);
  CHECK(controller.state() == State::update);
  tests::run(controller, samples, settings, 1);
  CHECK(controller.state() == State::ready);
}

}  // namespace
