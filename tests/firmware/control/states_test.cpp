// Tests the controller's state transitions while the force rises, reaches the force limit and is switched off.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

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

/// The box is far from the arm, so the wall force reaches the force limit.
Settings held_back() {
  protocol::ParameterSet set = parameters();
  set[box_minimum_x_m] = set[box_minimum_y_m] = set[box_minimum_z_m] = 0.4f;
  set[box_maximum_x_m] = set[box_maximum_y_m] = set[box_maximum_z_m] = 0.5f;
  return control::prepare(set);
}

/// Settings without contact.
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
  controller.carry_out(tests::command(Command::stop));
  CHECK_FALSE(tests::run(controller, samples, free, 1).enabled);
  CHECK(controller.state() == State::ready);
}

TEST_CASE("after disable_force, the force falls to zero within soft_landing_s, and then the bridges switch off") {
  protocol::ParameterSet set = parameters();
  constexpr int landing_periods = 400;
  set[soft_landing_s] = landing_periods * protocol::servo_period_s;
  set[box_minimum_x_m] = set[box_minimum_y_m] = set[box_minimum_z_m] = 0.4f;
  set[box_maximum_x_m] = set[box_maximum_y_m] = set[box_maximum_z_m] = 0.5f;
  const Settings pushed = control::prepare(set);
  const Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(pushed);
  tests::run(controller, samples, pushed, 2 * ramp_periods);
  const auto force_N = [&] { return controller.signals()[protocol::Signal::force_N]; };
  CHECK(force_N() == doctest::Approx(set[force_limit_N]));
  controller.carry_out(tests::command(Command::disable_force));
  tests::run(controller, samples, pushed, 1);
  CHECK(controller.state() == State::landing);
  for (int period = 1; period < landing_periods; ++period) {
    CHECK(tests::run(controller, samples, pushed, 1).enabled);
    CHECK(force_N() ==
          doctest::Approx(set[force_limit_N] * static_cast<float>(landing_periods - period) / landing_periods)
              .epsilon(1e-3));
  }
  CHECK_FALSE(tests::run(controller, samples, pushed, 2).enabled);  // rounding may add one period
  CHECK(controller.state() == State::ready);

  SUBCASE("a stop during the landing switches the force off immediately") {
    controller.carry_out(tests::command(Command::enable_force));
    tests::run(controller, samples, pushed, 2 * ramp_periods);
    controller.carry_out(tests::command(Command::disable_force));
    tests::run(controller, samples, pushed, landing_periods / 2);
    CHECK(force_N() > 1.0f);
    controller.carry_out(tests::command(Command::stop));
    CHECK_FALSE(tests::run(controller, samples, pushed, 1).enabled);
  }
  SUBCASE("a force that is enabled during the landing rises from its present value") {
    controller.carry_out(tests::command(Command::enable_force));
    tests::run(controller, samples, pushed, 2 * ramp_periods);
    controller.carry_out(tests::command(Command::disable_force));
    tests::run(controller, samples, pushed, landing_periods / 2);
    const float left_N = force_N();
    controller.carry_out(tests::command(Command::enable_force));
    CHECK(tests::run(controller, samples, pushed, 3).enabled);
    CHECK(controller.state() == State::ramping);
    CHECK(force_N() == doctest::Approx(left_N).scale(0).epsilon(0.02));
    tests::run(controller, samples, pushed, 10);
    CHECK(force_N() > left_N);
  }
}

TEST_CASE("while the force rises, a reached limit does not change the state") {
  const Settings pushed = held_back();
  Controller controller = tests::active_controller(pushed);
  tests::run(controller, tests::samples_at_rest(), pushed, ramp_periods / 2);
  CHECK(controller.limits() != 0);
  CHECK(controller.state() == State::ramping);
}

float speed_m_per_s(const Controller& controller) {
  const auto signals = controller.signals();
  return std::hypot(signals[protocol::Signal::velocity_x_m_s], signals[protocol::Signal::velocity_y_m_s],
                    signals[protocol::Signal::velocity_z_m_s]);
}

/// Rotates the waist until the probe exceeds its speed limit.
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

TEST_CASE("an arm whose host fell silent is braked gently: not in a period in which a motor resists with more") {
  Settings settings = free_space();
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  controller.host_alive();
  settings.limits.host_timeout_periods = 40;
  control::Drive drive;
  for (int i = 0; i < 100 && controller.state() != State::fault; ++i) {
    samples.encoder_counts[0] += i % 2;  // about 0.3 m/s, below the limit
    drive = tests::run(controller, samples, settings, 1);
  }
  REQUIRE(controller.fault() == Fault::host_silent);
  CHECK(drive.brake);
  const float gentle_A = control::Brake::gentle_part * settings.limits.brake_A[0];
  for (const bool resists : {true, false, true}) {
    samples.current_A[0] = resists ? 1.1f * gentle_A : 0.9f * gentle_A;
    samples.encoder_counts[0] += 1;
    drive = tests::run(controller, samples, settings, 1);
    CHECK_FALSE(drive.enabled);
    CHECK(drive.brake == !resists);
  }
}

TEST_CASE(
    "a USB loss under a force raises a fault and brakes the arm, and without a force or during a landing only stops "
    "it") {
  protocol::ParameterSet set = parameters();
  set[wall_stiffness_N_per_m] = set[wall_damping_Ns_per_m] = 0.0f;
  set[soft_landing_s] = 0.1f;
  const Settings settings = control::prepare(set);
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  for (int i = 0; i < 20; ++i) {
    samples.encoder_counts[0] += i % 2;  // about 0.3 m/s, below the limit
    tests::run(controller, samples, settings, 1);
  }
  const auto usb_goes = [&](Controller& of) {
    of.carry_out(tests::command(Command::stop));
    of.raise(Fault::usb_gone);
    return tests::run(of, samples, settings, 1);
  };
  Controller falling = controller;
  const control::Drive drive = usb_goes(controller);
  CHECK(controller.fault() == Fault::usb_gone);
  CHECK_FALSE(drive.enabled);
  CHECK(drive.brake);
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, samples, settings, 1);
  CHECK(controller.state() == State::ready);
  CHECK_FALSE(usb_goes(controller).brake);
  CHECK(controller.state() == State::ready);
  falling.carry_out(tests::command(Command::disable_force));
  tests::run(falling, samples, settings, 1);
  REQUIRE(falling.state() == State::landing);
  CHECK_FALSE(usb_goes(falling).enabled);
  CHECK(falling.state() == State::ready);
}

TEST_CASE("an arm whose force a user stops is not braked, however fast it is") {
  const Settings settings = free_space();
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  for (int i = 0; i < 20; ++i) {
    samples.encoder_counts[0] += i % 2;  // about 0.3 m/s, below the limit
    tests::run(controller, samples, settings, 1);
  }
  controller.carry_out(tests::command(Command::stop));
  const control::Drive drive = tests::run(controller, samples, settings, 1);
  CHECK(controller.state() == State::ready);
  CHECK(speed_m_per_s(controller) > control::Brake::speed_m_per_s);
  CHECK_FALSE(drive.enabled);
  CHECK_FALSE(drive.brake);
}

TEST_CASE("the brake ends with the fault, and with an unreliable bridge") {
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

TEST_CASE("the force switches off when the board leaves for its boot loader, and cannot be switched on meanwhile") {
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

TEST_CASE("a fault remains if the board leaves for its boot loader and then stays in its firmware") {
  const Settings settings = free_space();
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::active_controller(settings);
  samples.bridge_fault = true;
  tests::run(controller, samples, settings, 1);
  REQUIRE(controller.fault() == Fault::bridge_fault);
  controller.leave_for_update();
  tests::run(controller, samples, settings, 1);
  CHECK(controller.state() == State::update);
  CHECK(controller.fault() == Fault::bridge_fault);
  samples.bridge_fault = false;
  tests::run(controller, samples, settings, 2);
  CHECK(controller.state() == State::fault);
  CHECK(controller.fault() == Fault::bridge_fault);
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, samples, settings, 1);
  CHECK(controller.state() == State::ready);
}

}  // namespace
