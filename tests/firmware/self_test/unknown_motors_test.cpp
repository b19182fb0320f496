// The self-test before the motors are confirmed: missing motors and motors of other resistances.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/firmware/self_test/self_test_board.hpp"

namespace {

using namespace inkwell;
using protocol::Command;
using protocol::Fault;
using protocol::Limit;
using protocol::SelfTestItem;
using protocol::SelfTestResult;
using protocol::State;

/// A board in its first self-test. The parameters expect 2.18 ohm.
struct NewBoard : test::SelfTestBoard {
  float largest_A = 0.0f;

  NewBoard() { settings = control::prepare(tests::omni_parameters()); }

  void start() {
    run_while(State::starting);
    while (controller.state() == State::testing) {
      run(1);
      for (const tests::SimulatedMotor& motor : motors.motors)
        largest_A = std::max(largest_A, std::fabs(motor.current_A));
    }
  }

  /// Switches the force on and returns after a second. A wall of the box pushes with the force limit.
  void switch_force_on() {
    settings.box.minimum_m.z = 1.0f;
    samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
    run_while(State::unreferenced);
    samples.switches = 0;
    controller.carry_out(tests::command(Command::enable_force));
    for (int period = 0; period < 20'000; ++period) {
      controller.host_alive();
      run(1);
    }
  }
};

TEST_CASE("a new board without motors reports missing motors, and switches its bridges on at zero current") {
  NewBoard board;
  for (auto& motor : board.motors.motors) motor.is_open = true;
  board.start();
  CHECK(board.controller.state() == State::unreferenced);
  for (const SelfTestItem item : {SelfTestItem::motor_1, SelfTestItem::motor_2, SelfTestItem::motor_3})
    CHECK(board.result(item) == SelfTestResult::missing);
  CHECK(board.result(SelfTestItem::current_wires) == SelfTestResult::passed);
  CHECK(board.result(SelfTestItem::bridge_1) == SelfTestResult::not_done);
  board.offset_A = {0.02f, -0.02f, 0.03f};  // an integrator would leave the duty 0
  board.switch_force_on();
  CHECK(board.controller.state() == State::limited);
  CHECK(board.controller.limits() == static_cast<std::uint8_t>(Limit::motors));
  CHECK(board.drive.enabled);
  CHECK(board.drive.duty == control::Triple{});
  CHECK(board.controller.signals()[protocol::Signal::force_N] == 0.0f);
}

TEST_CASE("a board whose motors are confirmed fails the self-test for a missing or different motor") {
  for (const bool is_open : {true, false}) {
    NewBoard board;
    board.settings.motor_model.is_confirmed = true;
    board.motors.motors[1].is_open = is_open;
    board.motors.motors[1].resistance_ohm = 6.0f;
    board.start();
    CHECK(board.controller.fault() == Fault::self_test_failed);
    CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::failed);
  }
}

TEST_CASE("one connected motor passes, the others are missing, and no motor receives current for the force") {
  NewBoard board;
  board.motors.motors[0].is_open = board.motors.motors[2].is_open = true;
  board.start();
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::missing);
  CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::passed);
  CHECK(board.result(SelfTestItem::bridge_2) == SelfTestResult::passed);
  board.switch_force_on();
  CHECK(board.controller.state() == State::limited);
  CHECK(std::fabs(board.motors.motors[1].current_A) < 1e-6f);
}

TEST_CASE("motors of 0.5 to 30 ohm are measured with at most 0.8 A, and drive the force once they are confirmed") {
  for (const float resistance_ohm : {0.5f, 1.0f, 6.0f, 20.0f, 30.0f}) {
    CAPTURE(resistance_ohm);
    NewBoard board;
    for (auto& motor : board.motors.motors) motor.resistance_ohm = resistance_ohm;
    board.start();
    CHECK(board.controller.state() == State::unreferenced);
    for (const SelfTestItem item : {SelfTestItem::motor_1, SelfTestItem::motor_2, SelfTestItem::motor_3}) {
      CHECK(board.result(item) == SelfTestResult::unknown_motor);
      CHECK(board.figure(item) == doctest::Approx(resistance_ohm).epsilon(0.1));
    }
    CHECK(board.largest_A < 0.8f);

    protocol::ParameterSet confirmed = tests::confirmed_omni_parameters();
    for (const auto parameter :
         {protocol::Parameter::motor_resistance_1_ohm, protocol::Parameter::motor_resistance_2_ohm,
          protocol::Parameter::motor_resistance_3_ohm})
      confirmed[parameter] = resistance_ohm;
    board.settings = control::prepare(confirmed);
    board.controller.carry_out(tests::command(Command::self_test));
    board.run(1);
    board.run_while(State::testing);
    CHECK(board.controller.state() == State::unreferenced);
    CHECK(board.result(SelfTestItem::motor_3) == SelfTestResult::passed);
    board.switch_force_on();
    CHECK((board.controller.limits() & static_cast<std::uint8_t>(Limit::motors)) == 0);
    CHECK(board.controller.signals()[protocol::Signal::force_N] > 0.0f);
  }
}

TEST_CASE("unknown motors of a slowly moving arm are measured, whatever the torque constant of the parameters is") {
  constexpr int periods_per_count = 66;  // 0.1 rad/s
  NewBoard board;
  protocol::ParameterSet parameters = tests::omni_parameters();
  parameters[protocol::Parameter::torque_constant_2_Nm_per_A] = 1.0f;
  board.settings = control::prepare(parameters);
  for (auto& motor : board.motors.motors) motor.resistance_ohm = 6.0f;
  board.run_while(State::starting);
  for (int period = 0; board.controller.state() == State::testing; ++period) {
    board.samples.encoder_counts[1] += period % periods_per_count == 0;
    board.run(1);
  }
  CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::unknown_motor);
}

TEST_CASE("a first self-test of a moving arm drives only confirmed motors, and a later one of the resting arm all") {
  for (const bool is_confirmed : {false, true}) {
    CAPTURE(is_confirmed);
    NewBoard board;
    board.settings.motor_model.is_confirmed = is_confirmed;
    board.run_while(State::starting);
    while (board.controller.state() == State::testing) {
      ++board.samples.encoder_counts[1];
      board.run(1);
    }
    CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::moved);
    board.switch_force_on();
    const auto is_limited = [&] { return (board.controller.limits() & static_cast<std::uint8_t>(Limit::motors)) != 0; };
    CHECK(is_limited() == !is_confirmed);
    CHECK((board.drive.duty == control::Triple{}) == !is_confirmed);
    board.controller.carry_out(tests::command(Command::stop));
    board.run(2);
    board.controller.carry_out(tests::command(Command::self_test));
    board.run(1);
    board.run_while(State::testing);
    CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::passed);
    board.switch_force_on();
    CHECK_FALSE(is_limited());
  }
}

TEST_CASE("a self-test of a moving arm does not release motors that an earlier self-test found to be unknown") {
  NewBoard board;
  for (auto& motor : board.motors.motors) motor.resistance_ohm = 6.0f;
  board.start();
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(1);
  while (board.controller.state() == State::testing) {
    ++board.samples.encoder_counts[1];
    board.run(1);
  }
  CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::moved);
  board.switch_force_on();
  CHECK((board.controller.limits() & static_cast<std::uint8_t>(Limit::motors)) != 0);
  CHECK(board.drive.duty == control::Triple{});
}

TEST_CASE("a resistance below 0.4 ohm or above 40 ohm is a failure, not an unknown motor") {
  for (const float resistance_ohm : {0.3f, 45.0f}) {
    CAPTURE(resistance_ohm);
    NewBoard board;
    board.motors.motors[0].resistance_ohm = resistance_ohm;
    board.start();
    CHECK(board.controller.fault() == Fault::self_test_failed);
    CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::failed);
  }
}

TEST_CASE("swapped sense wires of a shunt are reported as a current of the wrong sign, confirmed or not") {
  for (const bool is_confirmed : {false, true}) {
    NewBoard board;
    board.settings.motor_model.is_confirmed = is_confirmed;
    board.motors.motors[2].sensor_gain = -1.0f;
    board.start();
    CHECK(board.controller.fault() == Fault::self_test_failed);
    CHECK(board.result(SelfTestItem::motor_3) == SelfTestResult::wrong_sign);
    CHECK(board.figure(SelfTestItem::motor_3) == doctest::Approx(-2.27).epsilon(0.02));
  }
}

TEST_CASE("swapped shunts are detected even if one of the two motors is missing") {
  NewBoard board;
  board.motors.motors[0].sensor = 1;
  board.motors.motors[1].sensor = 0;
  board.motors.motors[1].is_open = true;
  board.start();
  CHECK(board.controller.fault() == Fault::self_test_failed);
  CHECK(board.result(SelfTestItem::current_wires) == SelfTestResult::failed);
}

}  // namespace
