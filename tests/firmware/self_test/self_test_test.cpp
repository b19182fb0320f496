// Tests the self-test with main loop and control interrupt.
#include <doctest/doctest.h>

#include "tests/firmware/self_test/self_test_board.hpp"

namespace {

using namespace inkwell;
using link::SelfTest;
using protocol::Command;
using protocol::Fault;
using protocol::SelfTestItem;
using protocol::SelfTestResult;
using protocol::State;
using Board = test::SelfTestBoard;

TEST_CASE("a healthy board runs one self-test after its start in less than 20 ms, and every item passes") {
  Board board;
  board.run_while(State::starting);
  CHECK(board.controller.state() == State::testing);
  CHECK(board.run_while(State::testing) < 400);
  CHECK(board.controller.state() == State::unreferenced);
  CHECK(board.driven_periods == control::SelfTestPulses::round_periods);
  board.run(10);
  const auto report = board.link.self_test.report();
  CHECK(report.is_running == 0);
  CHECK(report.tests_begun == 1);
  CHECK(report.tests_ended == 1);
  for (std::size_t i = 0; i < protocol::self_test_item_count; ++i) {
    CAPTURE(protocol::self_test_item_table[i].name);
    const bool by_start_up = i < static_cast<std::size_t>(SelfTestItem::current_offsets);
    CHECK(report.entries[i].result == (by_start_up ? SelfTestResult::not_done : SelfTestResult::passed));
  }
  CHECK(board.figure(SelfTestItem::motor_3) == doctest::Approx(2.27).epsilon(0.02));
  CHECK(board.figure(SelfTestItem::gimbal_1) == 0.5f);
  board.run(1'000);
  CHECK(board.controller.state() == State::unreferenced);
}

TEST_CASE(
    "a self-test on command runs in the states unreferenced and ready, returns to them, and is refused while the force "
    "is on") {
  Board board;
  board.run_while(State::starting);
  board.run_while(State::testing);
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(1);
  CHECK(board.controller.state() == State::testing);
  CHECK(board.link.self_test.report().is_running == 1);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
  board.samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
  board.run_while(State::unreferenced);
  CHECK(board.controller.state() == State::ready);
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(1);
  CHECK(board.run_while(State::testing) > 100);
  board.run(2);
  CHECK(board.controller.state() == State::ready);
  CHECK(board.link.self_test.report().tests_ended == 3);
  board.controller.carry_out(tests::command(Command::enable_force));
  board.run(2);
  REQUIRE(protocol::force_is_on(board.controller.state()));
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(2);
  CHECK(protocol::force_is_on(board.controller.state()));
}

TEST_CASE("a repeated failure raises self_test_failed, and only a test that passes clears this fault") {
  Board board;
  board.motors.motors[1].is_open = true;
  board.run_while(State::starting);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::fault);
  CHECK(board.controller.fault() == Fault::self_test_failed);
  CHECK(board.driven_periods == SelfTest::failures_to_believe * control::SelfTestPulses::round_periods);
  CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::failed);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::passed);
  board.run(100);
  CHECK(board.result(SelfTestItem::bridge_2) == SelfTestResult::not_done);  // a failed motor leaves the bridge untested
  for (const Command again : {Command::clear_fault, Command::self_test}) {
    board.controller.carry_out(tests::command(again));
    board.run(1);
    CHECK(board.controller.state() == State::testing);
    board.run_while(State::testing);
    CHECK(board.controller.fault() == Fault::self_test_failed);
  }
  board.motors.motors[1].is_open = false;
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(1);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
  CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::passed);
}

TEST_CASE("a failure that does not repeat in the next round is ignored") {
  Board board;
  board.motors.motors[0].is_open = true;
  board.run_while(State::starting);
  while (board.driven_periods < control::SelfTestPulses::round_periods) board.run(1);
  board.motors.motors[0].is_open = false;
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
}

TEST_CASE("a self-test of an arm that always moves stops with the result moved and raises no fault") {
  Board board;
  board.motors.motors[0].is_open = true;
  board.run_while(State::starting);
  std::uint32_t periods = 0;
  for (; board.controller.state() == State::testing; ++periods) {
    if (periods % 10 == 0) ++board.samples.encoder_counts[0];
    board.run(1);
  }
  CHECK(board.controller.state() == State::unreferenced);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::moved);
  CHECK(board.result(SelfTestItem::motor_2) == SelfTestResult::passed);
  CHECK(board.driven_periods == SelfTest::rounds_maximum * control::SelfTestPulses::round_periods);
  CHECK(periods < protocol::servo_rate_Hz / 5);
}

TEST_CASE("a fast arm gets no pulses, because enabled bridges would brake it, and a stationary arm gets pulses") {
  for (const int direction : {1, -1}) {
    Board board;
    board.run_while(State::starting);
    std::uint32_t periods = 0;
    for (; board.controller.state() == State::testing && periods < 10'000; ++periods) {
      board.samples.encoder_counts[1] += direction;
      board.run(1);
    }
    CHECK(board.controller.state() == State::unreferenced);
    CHECK(board.driven_periods == 0);
    for (const SelfTestItem item : {SelfTestItem::motor_1, SelfTestItem::bridge_3, SelfTestItem::current_wires})
      CHECK(board.result(item) == SelfTestResult::moved);
    CHECK(periods < protocol::servo_rate_Hz / 5);

    board.controller.carry_out(tests::command(Command::self_test));
    for (int i = 0; i < 1'000; ++i) {
      board.samples.encoder_counts[1] += direction;
      board.run(1);
    }
    CHECK(board.driven_periods == 0);
    board.run_while(State::testing);
    CHECK(board.driven_periods == control::SelfTestPulses::round_periods);
    CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::passed);
  }
}

TEST_CASE("a wire fails its item if it follows the pull in every reading, and passes if one reading differs") {
  for (std::size_t item = static_cast<std::size_t>(SelfTestItem::encoder_1_a);
       item <= static_cast<std::size_t>(SelfTestItem::bridge_fault_tim8); ++item) {
    CAPTURE(protocol::self_test_item_table[item].name);
    Board board;
    board.floating = static_cast<SelfTestItem>(item);
    board.run_while(State::starting);
    board.run_while(State::testing);
    CHECK(board.controller.fault() == Fault::self_test_failed);
    for (std::size_t i = 0; i < protocol::self_test_item_count; ++i)
      CHECK((board.result(static_cast<SelfTestItem>(i)) == SelfTestResult::failed) == (i == item));
  }
  Board board;
  board.follows_by_chance = SelfTest::wire_readings - 1;
  board.run_while(State::starting);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
}

TEST_CASE("a gimbal potentiometer at an end of its track fails its item but raises no fault") {
  for (const float ratio : {0.0f, 0.005f, 0.995f, 1.0f}) {
    Board board;
    board.samples.gimbal_ratio[1] = ratio;
    board.run_while(State::starting);
    board.run_while(State::testing);
    CHECK(board.controller.state() == State::unreferenced);
    CHECK(board.result(SelfTestItem::gimbal_2) == SelfTestResult::failed);
    CHECK(board.figure(SelfTestItem::gimbal_2) == ratio);
    CHECK(board.result(SelfTestItem::gimbal_1) == SelfTestResult::passed);
  }
}

TEST_CASE("a RAM or watchdog failure at start-up fails its self-test item and raises self_test_failed") {
  for (const SelfTestItem item : {SelfTestItem::ram, SelfTestItem::watchdog}) {
    Board board;
    board.link.self_test.note(item, false);
    board.link.self_test.note(SelfTestItem::flash, true);
    board.run_while(State::starting);
    board.run_while(State::testing);
    CHECK(board.controller.fault() == Fault::self_test_failed);
    CHECK(board.result(item) == SelfTestResult::failed);
    CHECK(board.result(SelfTestItem::flash) == SelfTestResult::passed);
  }
}

TEST_CASE("a wrong analog supply raises self_test_failed, and its voltage is reported") {
  Board board;
  board.analog_supply_V = 3.0f;
  board.analog_supply_is_right = false;
  board.run_while(State::starting);
  board.run_while(State::testing);
  CHECK(board.controller.fault() == Fault::self_test_failed);
  CHECK(board.result(SelfTestItem::analog_supply) == SelfTestResult::failed);
  CHECK(board.figure(SelfTestItem::analog_supply) == 3.0f);
}

TEST_CASE("without a supply the self-test skips its pulses, reports this, and runs when a supply is present") {
  Board board;
  board.samples.supply_V = 0.0f;
  board.run_while(State::starting);
  board.run_while(State::testing);
  board.run(2);
  CHECK(board.controller.fault() == Fault::supply_low);
  CHECK(board.driven_periods == 0);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::broken_off);
  CHECK(board.result(SelfTestItem::bridge_3) == SelfTestResult::broken_off);
  CHECK(board.result(SelfTestItem::ram) == SelfTestResult::not_done);
  CHECK(board.link.self_test.report().tests_ended == 0);
  CHECK(board.link.self_test.report().is_running == 0);
  board.samples.supply_V = board::supply_nominal_V;
  board.run(1'000);
  board.controller.carry_out(tests::command(Command::clear_fault));
  board.run(1);
  CHECK(board.controller.state() == State::testing);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::passed);
}

TEST_CASE("a current sensor fault also fails the item current_offsets, although the motors are not tested") {
  Board board;
  for (int i = 0; i < 2'100; ++i) {
    board.motors.motors[1].current_A = 3.0f;
    board.run(1);
  }
  CHECK(board.controller.fault() == Fault::current_sensor);
  CHECK(board.result(SelfTestItem::current_offsets) == SelfTestResult::failed);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::not_done);
}

TEST_CASE("the reported offsets of the current sensors are the present offsets") {
  Board with_offset;
  with_offset.offset_A[0] = 0.1f;  // the controller subtracts the offset, but the report shows it
  with_offset.run_while(State::starting);
  with_offset.run_while(State::testing);
  CHECK(with_offset.figure(SelfTestItem::current_offsets) == doctest::Approx(0.1).epsilon(0.01));
  Board board;
  board.run_while(State::starting);
  board.run_while(State::testing);
  CHECK(std::fabs(board.figure(SelfTestItem::current_offsets)) < 0.001f);
  board.offset_A[2] = -0.2f;
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(1);
  board.run_while(State::testing);
  CHECK(board.figure(SelfTestItem::current_offsets) == doctest::Approx(-0.2).scale(0).epsilon(0.01));
  CHECK(board.result(SelfTestItem::current_offsets) == SelfTestResult::passed);
  board.offset_A[2] = -0.3f;  // too short to raise the fault of continuous monitoring
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(1);
  board.run_while(State::testing);
  CHECK(board.figure(SelfTestItem::current_offsets) == doctest::Approx(-0.3).scale(0).epsilon(0.01));
  CHECK(board.result(SelfTestItem::current_offsets) == SelfTestResult::failed);
  CHECK(board.controller.state() == State::fault);
}

TEST_CASE("damaged memory fails its self-test item, although the item passed at start-up") {
  Board board;
  board.link.self_test.note(SelfTestItem::flash, true);
  board.run_while(State::starting);
  board.run_while(State::testing);
  CHECK(board.result(SelfTestItem::flash) == SelfTestResult::passed);
  board.controller.raise(Fault::memory_damaged);
  board.run(1);
  CHECK(board.controller.fault() == Fault::memory_damaged);
  CHECK(board.result(SelfTestItem::flash) == SelfTestResult::failed);
}

TEST_CASE("a fault during the pulses switches off immediately, and the next test starts with the first motor") {
  Board board;
  board.run_while(State::starting);
  while (board.driven_periods < 130) board.run(1);
  board.samples.bridge_fault = true;
  board.run(1);
  CHECK(board.controller.fault() == Fault::bridge_fault);
  CHECK_FALSE(board.drive.enabled);
  board.run(5);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::broken_off);
  board.samples.bridge_fault = false;
  board.controller.carry_out(tests::command(Command::clear_fault));
  board.run(1);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
  CHECK(board.driven_periods == 130 + control::SelfTestPulses::round_periods);
}

TEST_CASE("a test that is broken off has no results of the one before") {
  Board board;
  board.run_while(State::starting);
  board.run_while(State::testing);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::passed);
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(20);
  board.samples.bridge_fault = true;
  board.run(2);
  CHECK(board.result(SelfTestItem::motor_1) == SelfTestResult::broken_off);
  CHECK(board.result(SelfTestItem::encoder_1_a) == SelfTestResult::passed);
}

TEST_CASE("after a fault aborts a self-test, its pulse order does not start pulses in the next self-test") {
  Board board;
  board.run_while(State::starting);
  while (!board.link.self_test.wanted_wire()) board.run(1);
  while (board.link.self_test.wanted_wire()) board.main_loop();
  board.main_loop();  // orders the pulses
  board.samples.bridge_fault = true;
  board.interrupt();
  board.samples.bridge_fault = false;
  board.controller.carry_out(tests::command(Command::clear_fault));
  board.interrupt();
  CHECK(board.controller.state() == State::testing);
  for (int i = 0; i < 5; ++i) board.interrupt();
  CHECK(board.driven_periods == 0);
  board.run_while(State::testing);
  CHECK(board.controller.state() == State::unreferenced);
}

TEST_CASE("the second of two self-tests starts again if the main loop missed the fault between them") {
  Board board;
  board.run_while(State::starting);
  while (board.driven_periods < 130) board.run(1);
  board.samples.bridge_fault = true;
  board.interrupt();
  board.samples.bridge_fault = false;
  board.controller.carry_out(tests::command(Command::clear_fault));
  board.interrupt();
  CHECK(board.controller.state() == State::testing);
  CHECK(board.run_while(State::testing) < 400);
  CHECK(board.controller.state() == State::unreferenced);
  CHECK(board.link.self_test.report().tests_begun == 2);
  CHECK(board.link.self_test.report().tests_ended == 1);
}

TEST_CASE("clearing another fault does not repeat a self-test that has passed") {
  Board board;
  board.run_while(State::starting);
  board.run_while(State::testing);
  board.controller.raise(Fault::servo_overrun);
  board.run(2);
  CHECK(board.controller.state() == State::fault);
  board.controller.carry_out(tests::command(Command::self_test));
  board.run(2);
  CHECK(board.controller.state() == State::fault);
  board.controller.carry_out(tests::command(Command::clear_fault));
  board.run(1);
  CHECK(board.controller.state() == State::unreferenced);
}

}  // namespace
