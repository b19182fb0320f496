// Tests the soak test's oracle with simulated board observations.
#include "host/lab/soak/oracle.hpp"

#include <doctest/doctest.h>

using namespace inkwell;
using namespace inkwell::soak;
using protocol::Fault;
using protocol::State;

namespace {

/// The oracle checks the board every 5 ms, and one pose arrives between two checks.
struct Watched {
  Oracle oracle;
  double now_s = 1.0;
  double driven_until_s = 0.0;
  double motor_force_N = 0.0;
  unsigned restarts = 0;
  std::uint32_t sequence = 100;

  explicit Watched(Kind kind = Kind::free_space) {
    oracle.limit_force(3.3);
    oracle.begin(1, kind);
    step(State::ready);
  }
  void step(State state, Fault fault = Fault::none) {
    device::Pose pose{};
    pose.state = state;
    pose.fault = fault;
    pose.sequence = ++sequence;
    pose.servo_load = 51;
    oracle.see(pose);
    now_s += 0.005;
    if (protocol::force_is_on(state)) driven_until_s = now_s;
    oracle.see(Snapshot{now_s, driven_until_s, restarts, motor_force_N, 0.5 * motor_force_N});
  }
  void steps(int count, State state, Fault fault = Fault::none) {
    for (int i = 0; i < count; ++i) step(state, fault);
  }
  void switch_on() {
    oracle.request_force();
    steps(10, State::active);
  }
  void check_only(Complaint complaint) const {
    REQUIRE(oracle.findings().size() == 1);
    CHECK(oracle.findings()[0].complaint == complaint);
  }
  void check_nothing() const { CHECK(oracle.findings().empty()); }
};

}  // namespace

TEST_CASE("a force that is requested, withdrawn and requested again causes no finding") {
  Watched board;
  board.switch_on();
  board.oracle.withdraw_force(0.0);
  board.step(State::active);  // a pose that was sent earlier
  board.steps(20, State::ready);
  board.switch_on();
  board.check_nothing();
  CHECK(board.oracle.poses() == 42);
  CHECK(board.oracle.longest_interrupt_part() == doctest::Approx(0.2));
}

TEST_CASE("a board drives for its self-test after a start and on command, and not a moment longer") {
  const auto drive = [](Watched& board, State state) {
    board.driven_until_s = board.now_s;
    board.step(state);
  };
  Watched on_command;
  drive(on_command, State::testing);
  on_command.steps(5, State::ready);
  on_command.check_nothing();
  drive(on_command, State::ready);
  on_command.check_only(Complaint::unasked_force);

  Watched restarted;
  ++restarted.restarts;
  restarted.oracle.see(Snapshot{restarted.now_s += 0.005, 0.0, restarted.restarts, 0.0});
  restarted.oracle.see(
      Snapshot{restarted.now_s += 0.1, restarted.now_s - 0.001, restarted.restarts, 0.0});  // no pose yet
  drive(restarted, State::starting);
  restarted.steps(5, State::unreferenced);
  restarted.check_nothing();
  drive(restarted, State::unreferenced);
  restarted.check_only(Complaint::unasked_force);
}

TEST_CASE("the oracle detects an unrequested force from the state, and from the bridges alone") {
  Watched by_state;
  by_state.switch_on();
  by_state.oracle.withdraw_force(0.0);
  by_state.steps(10, State::ready);
  by_state.step(State::ramping);
  CHECK(by_state.oracle.findings().at(0).complaint == Complaint::unasked_force);

  Watched by_bridges;
  by_bridges.switch_on();
  by_bridges.oracle.withdraw_force(0.0);
  by_bridges.steps(10, State::ready);
  by_bridges.check_nothing();
  by_bridges.driven_until_s = by_bridges.now_s;
  by_bridges.step(State::ready);
  by_bridges.check_only(Complaint::unasked_force);
}

TEST_CASE("a host that goes silently leaves the force on for its timeout and no longer") {
  Watched board(Kind::killed);
  board.switch_on();
  board.oracle.withdraw_force(0.05);
  board.steps(10, State::active);
  board.check_nothing();
  board.steps(10, State::active);
  board.check_only(Complaint::unasked_force);
}

TEST_CASE("a fault withdraws the request for a force, so that a force after clearing is a finding") {
  Watched board(Kind::silence);
  board.switch_on();
  board.steps(10, State::fault, Fault::host_silent);
  board.steps(10, State::ready);
  board.check_nothing();
  board.step(State::active);
  CHECK(board.oracle.findings().at(0).complaint == Complaint::unasked_force);
}

TEST_CASE("a fault is a false trip unless its phase may have it, and until its cause is gone") {
  Watched plain;
  plain.switch_on();
  plain.steps(3, State::fault, Fault::over_current);
  plain.check_only(Complaint::false_trip);
  CHECK(plain.oracle.faults_reported().at(Fault::over_current) == 1);

  Watched cable(Kind::cable);
  cable.step(State::fault, Fault::host_silent);
  cable.check_nothing();
  cable.step(State::fault, Fault::over_speed);
  cable.check_only(Complaint::false_trip);

  Watched healed(Kind::fault);
  healed.oracle.disturb(Disturbance::hardware);
  healed.step(State::fault, Fault::bridge_fault);
  healed.oracle.disturb(Disturbance::none);
  healed.oracle.allow_no_fault();
  healed.step(State::ready);
  healed.check_nothing();
  healed.step(State::fault, Fault::bridge_fault);
  healed.check_only(Complaint::false_trip);

  Watched lost(Kind::fault);
  lost.oracle.allow_lost_counts();
  lost.step(State::fault, Fault::encoder_implausible);
  lost.check_nothing();
  lost.step(State::fault, Fault::bridge_fault);
  lost.check_only(Complaint::false_trip);
}

TEST_CASE("the oracle reports a missed fault if the board reports no fault or another fault") {
  Watched board(Kind::too_fast);
  board.step(State::fault, Fault::over_speed);
  board.oracle.require_report_of(protocol::condition(Fault::over_speed));
  board.check_nothing();
  board.oracle.begin(2, Kind::silence);
  board.oracle.require_report_of(protocol::condition(Fault::host_silent));
  board.check_only(Complaint::missed_fault);
  Watched cable(Kind::cable);
  cable.step(State::fault, Fault::usb_gone);
  cable.oracle.require_report_of(soak::host_gone);
  cable.check_nothing();
  cable.oracle.begin(2, Kind::cable);
  cable.oracle.require_report_of(soak::host_gone);
  cable.check_only(Complaint::missed_fault);
  CHECK(cable.oracle.findings().at(0).text == "usb_gone or host_silent was not reported");
}

TEST_CASE("a force that switches off without a cause is a finding, except in a phase with an injected fault") {
  Watched board;
  board.switch_on();
  board.oracle.disturb(Disturbance::hardware);
  board.step(State::ready);
  board.check_nothing();
  board.step(State::active);
  board.oracle.disturb(Disturbance::none);
  board.step(State::ready);
  board.check_only(Complaint::lost_force);
}

TEST_CASE("motors may press with the limit and 5 % in a control period, in a millisecond where something is put in") {
  Watched board;
  board.switch_on();
  board.motor_force_N = 3.3 * 1.05;
  board.step(State::active);
  CHECK(board.oracle.hardest_press().part_of_limit() == doctest::Approx(1.05));
  board.motor_force_N = 5.0;
  board.oracle.disturb(Disturbance::hardware);
  board.step(State::active);
  board.oracle.disturb(Disturbance::none);
  board.oracle.limit_force(6.0);
  board.step(State::active);
  board.check_nothing();
  CHECK(board.oracle.hardest_press().part_of_limit() == doctest::Approx(1.05));
  CHECK(board.oracle.hardest_press_with_fault().part_of_limit() == doctest::Approx(5.0 / 3.3));
  CHECK(board.oracle.hardest_press_with_fault_over_ms().part_of_limit() == doctest::Approx(2.5 / 3.3));
  CHECK(board.oracle.hardest_press_with_fault().kind == Kind::free_space);
  board.oracle.limit_force(3.3);
  SUBCASE("for a period") {
    board.step(State::active);
    board.check_only(Complaint::too_much_force);
  }
  SUBCASE("for a millisecond with something put in") {
    board.oracle.disturb(Disturbance::hardware);
    board.motor_force_N = 2 * 3.3 * 1.05 + 0.1;
    board.step(State::active);
    board.check_nothing();
    board.motor_force_N += 0.2;
    board.step(State::active);
    board.check_only(Complaint::too_much_force);
  }
  SUBCASE("for a millisecond with a program that is not the one that was flashed") {
    board.oracle.disturb(Disturbance::program);
    board.motor_force_N = 10;
    board.step(State::active);
    board.check_nothing();
    CHECK(board.oracle.hardest_press_with_fault_over_ms().part_of_limit() == doctest::Approx(5.0 / 3.3));
  }
}

TEST_CASE("the oracle does not rate motor noise relative to a very small force limit") {
  Watched weak;
  weak.switch_on();
  weak.motor_force_N = 0.1;
  for (const double limit_N : {0.01, 0.4}) {
    weak.oracle.limit_force(limit_N);
    weak.step(State::active);
    CHECK(weak.oracle.hardest_press().part_of_limit() == 0.0);
  }
  weak.oracle.limit_force(0.5);
  weak.step(State::active);
  CHECK(weak.oracle.hardest_press().part_of_limit() == doctest::Approx(0.2));
  weak.check_nothing();
}

TEST_CASE("the oracle detects an excessive force that switches on and off between two readings") {
  Watched board(Kind::too_fast);
  board.motor_force_N = 5.0;
  board.oracle.request_force();
  device::Pose pose{};
  pose.state = State::active;
  pose.sequence = ++board.sequence;
  board.oracle.see(pose);
  board.step(State::fault, Fault::over_speed);
  board.check_only(Complaint::too_much_force);
}

TEST_CASE("the oracle judges the motor force while the force switches off, and not after it is off") {
  Watched tripped(Kind::too_fast);
  tripped.switch_on();
  tripped.motor_force_N = 5.0;
  SUBCASE("as the force goes off") {
    tripped.step(State::fault, Fault::over_speed);
    tripped.check_only(Complaint::too_much_force);
  }
  SUBCASE("once it is off") {
    tripped.motor_force_N = 0.0;
    tripped.step(State::fault, Fault::over_speed);
    tripped.motor_force_N = 5.0;
    tripped.step(State::fault, Fault::over_speed);
    tripped.check_nothing();
  }
  SUBCASE("the board restarts and runs its self-test") {
    ++tripped.restarts;
    tripped.oracle.disturb(Disturbance::hardware);
    for (int look = 0; look < 4; ++look)
      tripped.oracle.see(Snapshot{tripped.now_s, tripped.driven_until_s, tripped.restarts, tripped.motor_force_N,
                                  tripped.motor_force_N});
    tripped.step(State::testing);
    tripped.step(State::ready);
    CHECK(tripped.oracle.hardest_press_with_fault().part_of_limit() == 0.0);
    tripped.motor_force_N = 1.0;
    tripped.steps(2, State::active);
    CHECK(tripped.oracle.hardest_press_with_fault().part_of_limit() == doctest::Approx(1.0 / 3.3));
  }
}

TEST_CASE(
    "a restart is a finding unless it was wanted or something is put in; a wanted one takes the force's permission") {
  Watched board;
  board.switch_on();
  CHECK_FALSE(board.oracle.see_counts(0, 0, ""));
  board.oracle.expect_restart();
  CHECK(board.oracle.see_counts(1, 0, ""));
  CHECK_FALSE(board.oracle.force_is_requested());
  board.oracle.disturb(Disturbance::hardware);
  CHECK(board.oracle.see_counts(3, 0, ""));
  board.oracle.disturb(Disturbance::none);
  board.check_nothing();
  board.oracle.see_counts(4, 0, "");
  board.check_only(Complaint::restart);
  CHECK(board.oracle.restarts() == 4);
}

TEST_CASE("a rule that the firmware breaks is a finding even with broken hardware, but not of a program gone astray") {
  Watched board(Kind::fault);
  board.oracle.disturb(Disturbance::program);
  board.oracle.see_counts(0, 2, "a rule");
  board.check_nothing();
  board.oracle.disturb(Disturbance::hardware);
  board.oracle.see_counts(0, 2, "a rule");
  board.check_nothing();
  board.oracle.see_counts(0, 3, "a rule");
  board.check_only(Complaint::broken_rule);
}

TEST_CASE("poses that are missing within a connection are a finding, those between two connections are not") {
  Watched board;
  board.oracle.connected();
  board.sequence += 1000;
  board.step(State::ready);
  CHECK(board.oracle.poses_lost() == 0);
  board.check_nothing();
  board.sequence += 3;
  board.step(State::ready);
  CHECK(board.oracle.poses_lost() == 3);
  board.check_only(Complaint::lost_packets);
}

TEST_CASE("poses that are missing while something was put in are counted by themselves") {
  Watched board(Kind::fault);
  board.oracle.disturb(Disturbance::hardware);
  board.sequence += 70;
  board.step(State::ready);
  board.oracle.disturb(Disturbance::none);
  board.step(State::ready);
  CHECK(board.oracle.poses_kept_back() == 70);
  CHECK(board.oracle.poses_lost() == 0);
  board.check_nothing();
}

TEST_CASE("of several complaints of a kind in a phase the first is kept") {
  Watched board;
  board.step(State::fault, Fault::over_current);
  board.step(State::ready);
  board.step(State::fault, Fault::motor_hot);
  board.check_only(Complaint::false_trip);
  CHECK(board.oracle.findings()[0].text == "over_current");
  CHECK(board.oracle.findings()[0].kind == Kind::free_space);
  board.oracle.begin(2, Kind::walls);
  board.step(State::ready);
  board.step(State::fault, Fault::motor_hot);
  CHECK(board.oracle.findings().size() == 2);
}
