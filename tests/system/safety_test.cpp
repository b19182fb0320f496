// Tests the safety of the hand: no force without a reference, no force without a host, and bridges off after a fault.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "boards/omni_driver/facts.hpp"

#include "tests/system/firmware_image.hpp"
#include "tests/system/hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
using protocol::State;

TEST_CASE("an arm that has not been in the inkwell gets no force") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.take_to(free_point_m);
  rig.control.reset();
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().state == State::unreferenced);
  rig.command(protocol::Command::enable_force);
  rig.run(0.3);
  CHECK(rig.pose().state == State::unreferenced);
  CHECK(largest_current_A(rig.control) < 0.02);

  // Puts the stylus into the inkwell for a new reference.
  rig.control.dock(true);
  rig.control.hand({.holds = false});
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

TEST_CASE("the force goes off when the host falls silent") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_minimum_z_m, -0.015f}});  // inside the wall
  rig.run(0.1);
  CHECK(largest_current_A(rig.control) > 0.1);
  rig.set({{Parameter::host_timeout_s, 0.05f}});
  rig.run_silent(0.1);
  CHECK(largest_current_A(rig.control) < 0.02);
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::host_silent);
}

TEST_CASE("a test's pulse goes off with a stop, a host that falls silent and a cable that is pulled") {
  const auto stop = [](BoardRig& rig) {
    rig.command(protocol::Command::stop);
    rig.run(0.02);
  };
  const auto fall_silent = [](BoardRig& rig) { rig.run_silent(0.06); };
  const auto pull_cable = [](BoardRig& rig) {
    rig.control.usb(false);
    rig.control.run(0.02);
  };
  for (const std::function<void(BoardRig&)>& end :
       {std::function<void(BoardRig&)>(stop), {fall_silent}, {pull_cable}}) {
    BoardRig rig;
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
    rig.set({{Parameter::host_timeout_s, 0.05f}});
    rig.device->send(protocol::Command::test_current, {.motor = 2, .amplitude = 1.0f, .duration_s = 0.1f});
    rig.run(0.01);
    REQUIRE(largest_current_A(rig.control) > 0.9);
    end(rig);
    CHECK(largest_current_A(rig.control) < 0.02);
    CHECK_FALSE(bridges_enabled(rig.control));
  }
}

TEST_CASE("a failing supply switches the bridges off and raises supply_low") {
  BoardRig rig;
  rig.make_active();
  rig.control.supply(9.0);  // the board's capacitors supply the bridges for a while
  rig.run_until([](const auto& pose) { return pose.state == State::fault; });
  CHECK(rig.pose().fault == protocol::Fault::supply_low);
  CHECK(largest_current_A(rig.control) < 0.02);
  rig.control.supply(static_cast<double>(board::supply_nominal_V));
  rig.run(0.3);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

TEST_CASE("refused parameters do not move a motor") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  for (float value : {std::nanf(""), 1e30f, -1e30f}) {
    CHECK_THROWS_AS(rig.set({{Parameter::wall_stiffness_N_per_m, value}}), device::Refused);
    rig.run(0.05);
    CHECK(largest_current_A(rig.control) < 0.05);
  }
}

TEST_CASE("a bridge that reports a fault stops all of them at the next control period") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"bridge_fault"});
  rig.control.run(1.5 * control_period_s);  // until the next control interrupt has finished
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::bridge_fault);
  CHECK(largest_current_A(rig.control) < 0.02);

  // The fault cannot be cleared while its cause lasts.
  rig.command(protocol::Command::clear_fault);
  rig.run(0.05);
  CHECK(rig.pose().state == State::fault);
  rig.control.heal("bridge_fault");
  rig.run(0.05);
  CHECK(rig.pose().state == State::fault);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));

  rig.control.inject({"bridge_fault"});
  rig.run(0.05);
  check_reports(reported_by_info(rig), protocol::Fault::bridge_fault);
}

TEST_CASE("an arm that is too fast is braked by the back EMF of its motors until it is slow, and is then released") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::speed_limit_m_per_s, 0.2f}});
  rig.control.hand_path({{0.2, {0.0, 0.06, -0.03}}, {0.4, {0.0, 0.06, -0.03}}});
  rig.run_until([](const auto& pose) { return pose.state == State::fault; });
  CHECK(rig.pose().fault == protocol::Fault::over_speed);
  CHECK(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  CHECK(largest_current_A(rig.control) > 0.05);
  const auto truth = rig.control.truth();
  CHECK(truth.at("bridges_driven_until_s").get<double>() < truth.at("board_time_s").get<double>() - control_period_s);
  rig.run(0.3);
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK(largest_current_A(rig.control) < 0.02);
}

namespace {

/// The hand swings while the host is silent.
void let_host_fall_silent(BoardRig& rig) {
  rig.make_active();
  rig.take_to(free_point_m);
  rig.control.hand_path({{0.1, {0.0, 0.06, -0.03}}, {0.25, {0.0, -0.06, -0.03}}, {0.4, {0.0, 0.06, -0.03}}});
  rig.run(0.13);
  rig.set({{Parameter::host_timeout_s, 0.05f}});  // last message of the host
}

}  // namespace

TEST_CASE("an arm whose host fell silent while a hand swings it is braked now and then, and no leg is high meanwhile") {
  BoardRig rig;
  let_host_fall_silent(rig);
  rig.control.run(0.0501);
  constexpr int parts = 10, fast_periods = 100;
  int on = 0, off = 0, parts_on = 0, longest_parts = 0;
  double largest_A = 0;
  for (int period = 0; period < 400; ++period) {
    (bridges_enabled(rig.control) ? on : off) += 1;
    for (int part = 0; part < parts; ++part) {
      rig.control.run(control_period_s / parts);
      CHECK_FALSE(any_leg_high(rig.control));
      largest_A = std::max(largest_A, largest_current_A(rig.control));
      parts_on = bridges_enabled(rig.control) ? parts_on + 1 : 0;
      if (period < fast_periods) longest_parts = std::max(longest_parts, parts_on);
    }
  }
  CHECK(on > 50);
  CHECK(off > 50);
  CHECK(largest_A > 0.1);
  // While the hand is fast, the board releases the brake within one control period. A release or braking that is late
  // by half a period fails this check.
  CHECK(longest_parts >= parts - 2);
  CHECK(longest_parts <= parts + 2);
  rig.control.run(0.5);
  CHECK_FALSE(bridges_enabled(rig.control));
  rig.run_until([](const auto& pose) { return pose.state == State::fault; });
  CHECK(rig.pose().fault == protocol::Fault::host_silent);
}

TEST_CASE("a bridge fault ends the gentle brake") {
  BoardRig rig;
  let_host_fall_silent(rig);
  rig.control.run(0.06);
  int on = 0;
  for (int period = 0; period < 10; ++period) {
    rig.control.run(control_period_s);
    on += bridges_enabled(rig.control);
  }
  REQUIRE(on > 0);
  rig.control.inject({"bridge_fault"});
  rig.control.run(1.5 * control_period_s);
  for (int period = 0; period < 40; ++period) {
    rig.control.run(control_period_s);
    CHECK_FALSE(bridges_enabled(rig.control));
  }
}

TEST_CASE("a bridge fault ends the brake of an arm that was too fast") {
  BoardRig rig;
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::speed_limit_m_per_s, 0.2f}});
  rig.control.hand_path({{0.2, {0.0, 0.06, -0.03}}, {0.4, {0.0, 0.06, -0.03}}});
  rig.run_until([](const auto& pose) { return pose.state == State::fault; });
  REQUIRE(bridges_enabled(rig.control));
  rig.control.inject({"bridge_fault"});
  rig.control.run(1.5 * control_period_s);
  CHECK_FALSE(bridges_enabled(rig.control));
}

TEST_CASE("a CPU fault switches active bridges off first and is reported after the restart") {
  BoardRig rig(device::SimulationMode::exact);
  press_into_wall(rig);
  constexpr std::uint32_t nothing_there = 0x60000000;
  rig.control.inject({"program_astray", std::to_string(nothing_there)});
  constexpr double step_s = 50e-9;
  for (int step = 0; step < 20 && bridges_enabled(rig.control); ++step) rig.control.run(step_s);
  rig.control.run(5 * step_s);  // the writes that switch off the outputs of both timers pass the APB2 bus
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high(rig.control));
  CHECK(restarts(rig.control) == 0);  // the handler switched the outputs off, not a reset
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  CHECK_FALSE(any_leg_high_within(rig.control, 0.02));
  CHECK(largest_current_A(rig.control) < 0.02);
  CHECK(restarts(rig.control) == 1);
  CHECK(watchdog_expires(rig.control) == 0);

  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::processor_fault);
  check_reports(reported_by_info(rig), protocol::Fault::processor_fault);
}

TEST_CASE("firmware that hangs while the bridges are on is restarted by the watchdog and reports the reset") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"program_astray", std::to_string(endless_loop_address())});
  rig.control.run(0.04);  // the slowest watchdog of the data sheet expires after 38 ms
  CHECK(watchdog_expires(rig.control) == 1);
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, 0.02));
  CHECK(largest_current_A(rig.control) < 0.02);

  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::watchdog);
  check_reports(reported_by_info(rig), protocol::Fault::watchdog);
}
