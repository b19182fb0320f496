// Tests how the control interrupt uses the self-test's data of motors and bridges.
#include "tests/firmware/self_test/self_test_board.hpp"

namespace {

using namespace inkwell;
using protocol::Command;
using protocol::Fault;
using protocol::SelfTestItem;
using protocol::SelfTestResult;
using protocol::State;

/// A program applies the maximum force in one direction.
struct PushedBoard : test::SelfTestBoard {
  std::size_t strongest = 0;  ///< motor with the largest current

  PushedBoard() { settings.force_limit_N = settings.program_force.force_limit_N = 2.5f; }

  void test_after_start() {
    run_while(State::starting);
    run_while(State::testing);
  }

  /// Runs a self-test while the arm moves. The motors cannot be measured while the arm moves.
  void test_while_it_moves() {
    controller.carry_out(tests::command(Command::self_test));
    run(1);
    for (int period = 0; controller.state() == State::testing && period < 10'000; ++period) {
      samples.encoder_counts[0] += 12;
      run(1);
    }
    samples.encoder_counts[0] = 0;
    REQUIRE(result(SelfTestItem::bridge_1) == SelfTestResult::moved);
    REQUIRE(result(SelfTestItem::motor_1) == SelfTestResult::moved);
  }

  void make_active() {
    samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
    run_while(State::unreferenced);
    controller.carry_out(tests::command(Command::enable_force));
    run(2);
    REQUIRE(protocol::force_is_on(controller.state()));
    push(6'000);
    for (std::size_t i = 1; i < 3; ++i)
      if (std::fabs(samples.current_A[i]) > std::fabs(samples.current_A[strongest])) strongest = i;
    REQUIRE(protocol::is_reached(controller.limits(), protocol::Limit::force));
    REQUIRE(controller.fault() == Fault::none);
  }

  void push(int periods) {
    for (; periods > 0; --periods) {
      controller.host_alive();
      controller.drive({{5.0f, 0.0f, 0.0f}, protocol::ForceMode::beside_walls}, settings);
      run(1);
    }
  }

  /// Ratio of the true current to the reference of the motor with the largest current.
  float part_of_reference() const {
    const auto signal = of_axis(protocol::Signal::current_reference_1_A, strongest);
    return motors.motors[strongest].current_A / controller.signals()[signal];
  }
};

TEST_CASE(
    "a halved winding resistance is detected at a usual current only after the self-test has measured the motors") {
  for (const bool is_tested : {true, false}) {
    CAPTURE(is_tested);
    PushedBoard board;
    board.test_after_start();
    if (is_tested)
      board.test_while_it_moves();  // the earlier measurement is retained
    else
      board.controller.pass_self_test({});
    board.make_active();
    const float current_A = std::fabs(board.samples.current_A[board.strongest]);
    REQUIRE(current_A > 0.7f);  // the defect is detectable above 0.6 A, and without the self-test above 1.8 A
    REQUIRE(current_A < 1.2f);
    board.motors.motors[board.strongest].resistance_ohm *= 0.5f;
    board.push(2'000);
    CHECK((board.controller.fault() == Fault::motor_implausible) == is_tested);
  }
}

TEST_CASE("the self-test measures the resistance, so that a motor with 33 % more still has its full current") {
  PushedBoard board;
  for (auto& motor : board.motors.motors) motor.resistance_ohm *= 1.33f;
  board.test_after_start();
  board.make_active();
  CHECK(board.part_of_reference() == doctest::Approx(1.0).epsilon(0.005));
}

TEST_CASE("and one whose sensor loses a tenth of its gain since then has 6 % more at most, also if it was warm") {
  for (const float heat : {0.0f, 0.4f})
    for (const bool tests_again : {false, true}) {
      CAPTURE(heat);
      CAPTURE(tests_again);
      PushedBoard board;
      board.controller.start_warm({.heat = {heat, heat, heat}, .housing = {heat, heat, heat}, .too_hot = 0});
      board.test_after_start();
      if (tests_again) board.test_while_it_moves();
      board.make_active();
      board.motors.motors[board.strongest].sensor_gain = 0.9f;
      board.push(200);
      CHECK(board.part_of_reference() > 1.03f);
      CHECK(board.part_of_reference() < 1.06f);
      CHECK(board.controller.fault() == Fault::none);
    }
}

TEST_CASE("a motor that its current has warmed since the test gets the voltage for it") {
  PushedBoard board;
  board.test_after_start();
  board.make_active();
  // The test shortens the time constants of the motor model to save time.
  board.settings.heat.housing_per_update = board.settings.heat.winding_per_update = 0.05f;
  board.push(20'000);
  const float heat = board.controller.motor_heat()[board.strongest];
  REQUIRE(heat > 0.3f);
  board.motors.motors[board.strongest].resistance_ohm *= 1.0f + 0.39f * heat;
  board.push(200);
  CHECK(board.part_of_reference() == doctest::Approx(1.0).epsilon(0.005));
}

}  // namespace
