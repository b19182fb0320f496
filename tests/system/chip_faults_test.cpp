// Tests the reaction of the flashed firmware to failures of the chip while the bridges are on.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "boards/stm32f405/core/exception_numbers.hpp"

#include "tests/system/firmware_image.hpp"
#include "tests/system/hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::Parameter;
using protocol::State;

namespace {

constexpr int control_interrupt = virtual_board::exception_of(virtual_board::converters_position);

/// Returns true if any motor had a voltage at one of 60 instants within three PWM periods.
bool any_motor_driven(device::ControlClient& control) {
  bool driven = false;
  for (int i = 0; i < 60; ++i) {
    control.run(control_period_s / 60);
    const auto truth = control.truth();
    for (const auto& legs : truth.at("bridge_legs")) driven |= legs.at(0) != legs.at(1);
  }
  return driven;
}

/// Stops board time inside the control interrupt, after the first register writes.
void run_into_control_interrupt(BoardRig& rig) {
  const auto exception = [&] { return rig.control.status().all.at("exception").get<int>(); };
  while (exception() == control_interrupt) rig.control.run(1e-6);
  while (exception() != control_interrupt) rig.control.run(1e-6);
  rig.control.run(2e-6);
  REQUIRE(exception() == control_interrupt);
}

void check_fault_after_restart(BoardRig& rig, Fault fault) {
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == fault);
}

void check_bridges_off(BoardRig& rig) {
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
}

}  // namespace

TEST_CASE("a control interrupt that never ends leaves the motors without voltage until the watchdog expires") {
  BoardRig rig;
  press_into_wall(rig);
  REQUIRE(any_motor_driven(rig.control));
  run_into_control_interrupt(rig);
  rig.control.inject({"program_astray", std::to_string(endless_loop_address())});
  rig.control.run(control_period_s);  // the first duty cycles that the interrupt wrote become active
  CHECK(restarts(rig.control) == 0);
  CHECK_FALSE(any_motor_driven(rig.control));
  rig.control.run(0.04);
  CHECK(watchdog_expires(rig.control) == 1);
  check_bridges_off(rig);
  check_fault_after_restart(rig, Fault::watchdog);
}

TEST_CASE("a control interrupt that does not finish within its period is a fault") {
  BoardRig rig;
  press_into_wall(rig);
  run_into_control_interrupt(rig);
  rig.control.inject({"core_stalled", "", 1.2 * control_period_s});
  rig.control.run(3 * control_period_s);
  check_bridges_off(rig);
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == Fault::servo_overrun);
  CHECK(restarts(rig.control) == 0);
}

TEST_CASE("a short processor stall outside an interrupt is not a fault") {
  BoardRig rig;
  press_into_wall(rig);
  run_into_control_interrupt(rig);
  while (rig.control.status().all.at("exception") == control_interrupt) rig.control.run(1e-6);
  rig.control.inject({"core_stalled", "", 2e-6});
  rig.run(0.02);
  CHECK(protocol::force_is_on(rig.pose().state));
}

TEST_CASE("a debug halt of the core switches the motor voltage and the bridges off, and pauses the watchdog") {
  BoardRig rig;
  press_into_wall(rig);
  REQUIRE(any_motor_driven(rig.control));
  rig.control.inject({"core_halted", "", 0.1});
  CHECK_FALSE(any_leg_high_within(rig.control, 0.0001));
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, 0.0009));
  rig.control.run(0.098);
  CHECK_FALSE(any_leg_high_within(rig.control, 0.0005));
  rig.control.run(0.001);
  CHECK(restarts(rig.control) == 0);
  // The force does not return automatically.
  CHECK_FALSE(any_leg_high_within(rig.control, 0.0005));
  rig.control.run(0.05);
  CHECK(restarts(rig.control) == 0);
  check_bridges_off(rig);
  rig.run(0.01);
  CHECK(rig.pose().fault == Fault::heartbeat_missed);
}

TEST_CASE("a core stall of 0.2 ms or more switches the bridges off and raises a fault") {
  for (const double stands_s : {0.2e-3, 1e-3, 8e-3}) {
    CAPTURE(stands_s);
    BoardRig rig;
    press_into_wall(rig);
    rig.control.inject({"core_stalled", "", stands_s});
    rig.control.run(stands_s + 2 * control_period_s);
    check_bridges_off(rig);
    rig.run(0.02);
    CHECK(restarts(rig.control) == 0);
    CHECK(rig.pose().state == State::fault);
    CHECK((rig.pose().fault == Fault::heartbeat_missed || rig.pose().fault == Fault::servo_overrun));
    rig.command(protocol::Command::clear_fault);
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  }
}

TEST_CASE("the watchdog expires if the control interrupt stops while the main loop runs") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"exception_lost", std::to_string(control_interrupt)});
  rig.control.run(0.0001);
  CHECK(watchdog_expires(rig.control) == 0);
  CHECK_FALSE(bridges_enabled(rig.control));  // no heartbeat
  rig.control.run(0.04);                      // the slowest watchdog of the data sheet expires after 38 ms
  CHECK(watchdog_expires(rig.control) == 1);
  check_bridges_off(rig);
  rig.control.heal("exception_lost");
  rig.control.run(0.04);  // the restart may also have been affected by the lost interrupt
  check_fault_after_restart(rig, Fault::watchdog);
  // The next reset does not report the same fault again.
  rig.control.reset();
  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().fault != Fault::watchdog);
}

TEST_CASE("the control interrupt detects a stalled main loop after 10 ms, before the watchdog expires") {
  BoardRig rig;
  constexpr double patience_s = static_cast<double>(protocol::main_loop_stalled_s);
  press_into_wall(rig);
  rig.control.inject({"main_loop_stalled", "", 0.95 * patience_s});
  rig.control.run(patience_s);
  CHECK(any_motor_driven(rig.control));
  rig.run(0.1);
  CHECK(force_is_on(rig.pose().state));

  rig.control.inject({"main_loop_stalled", "", 10.0});
  rig.control.run(0.95 * patience_s);
  CHECK(bridges_enabled(rig.control));
  rig.control.run(0.05 * patience_s + 2 * control_period_s);
  check_bridges_off(rig);
  CHECK(watchdog_expires(rig.control) == 0);
  rig.control.run(0.04);  // the slowest watchdog of the data sheet expires after 38 ms
  CHECK(watchdog_expires(rig.control) == 1);
  check_fault_after_restart(rig, Fault::watchdog);
}

TEST_CASE("a main loop that recovers before the watchdog expires raises main_loop_stalled") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"main_loop_stalled", "", 1.2 * static_cast<double>(protocol::main_loop_stalled_s)});
  rig.run(0.1);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == Fault::main_loop_stalled);
  CHECK(watchdog_expires(rig.control) == 0);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}

TEST_CASE(
    "a stopped crystal switches the bridges off immediately, and the board starts and reports the fault when the "
    "crystal runs again") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"crystal_stop"});
  rig.control.run(2e-6);
  check_bridges_off(rig);
  rig.control.run(0.05);
  CHECK(restarts(rig.control) == 1);  // by the fault handler; without a crystal the watchdog is neither fed nor started
  check_bridges_off(rig);
  CHECK_FALSE(rig.board.find());

  rig.control.heal("crystal_stop");
  check_fault_after_restart(rig, Fault::crystal_failed);
  check_reports(reported_by_info(rig), Fault::crystal_failed);
  rig.control.reset();
  reconnect(rig);
  rig.run_until([](const auto& pose) { return pose.state == State::ready || pose.state == State::unreferenced; });
}

TEST_CASE("a spike of 100 ns on an encoder's wire leaves the pose alone; a long one shows a count while it lasts") {
  BoardRig rig;
  rig.run(0.3);
  const auto joint_rad = [&] { return static_cast<double>(rig.pose().joint_rad[0]); };
  const double before_rad = joint_rad();
  constexpr double one_count_rad = 2 * std::numbers::pi / (13.3 * 1440);
  rig.control.glitch("PA0", 100e-9);
  rig.run(0.02);
  CHECK(joint_rad() == before_rad);
  rig.control.glitch("PA0", 0.05);
  rig.run(0.02);
  CHECK(std::abs(joint_rad() - before_rad) / one_count_rad == doctest::Approx(1.0).epsilon(0.01));
  rig.run(0.06);
  CHECK(joint_rad() == before_rad);
}

TEST_CASE("a spike on one encoder wire during a pulse on the other is no whole step of the disc") {
  // The filter delays the pulse by 0.33 us to 0.38 us, and the spike covers the delayed end of the pulse. Without
  // filtering of the spike, the encoder lines would pass through all four states.
  constexpr double pulse_s = 1e-6, spike_after_s = 1.31e-6, spike_s = 0.1e-6, soon_s = 1e-6;
  BoardRig rig(device::SimulationMode::exact);  // in fast mode a spike may last for one more block of instructions
  rig.run(0.3);
  const auto before = rig.pose();
  for (int encoder = 0; encoder < 3; ++encoder)
    for (const std::string pulsed : {"a", "b"})
      for (const std::string pulse : {"wire_high", "wire_low"})
        for (const std::string spike : {"wire_high", "wire_low"}) {
          // Pulse and spike invert both wires in one of the four combinations.
          const std::string wires = fmt::format("encoders[{}].", encoder), spiked = pulsed == "a" ? "b" : "a";
          rig.control.inject({pulse, wires + pulsed, {}, soon_s, pulse_s});
          rig.control.inject({spike, wires + spiked, {}, soon_s + spike_after_s, spike_s});
          rig.run(0.01);
        }
  for (int joint = 0; joint < 3; ++joint) CHECK(rig.pose().joint_rad[joint] == before.joint_rad[joint]);
}

TEST_CASE("a host with signs of life retains the force, and a host without them loses it") {
  BoardRig rig;
  press_into_wall(rig);
  rig.set({{Parameter::host_timeout_s, 0.05f}});
  for (int i = 0; i < 20; ++i) {
    rig.command(protocol::Command::heartbeat);
    rig.run_silent(0.02);
  }
  CHECK(protocol::force_is_on(rig.pose().state));
  rig.run_silent(0.1);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == Fault::host_silent);
  check_bridges_off(rig);
}

TEST_CASE("force that is switched off leaves no leg of a bridge on") {
  BoardRig rig;
  press_into_wall(rig);
  rig.command(protocol::Command::stop);
  rig.run(0.02);
  CHECK(rig.pose().state == State::ready);
  check_bridges_off(rig);
}

TEST_CASE("after a bridge's fault is cleared the force comes on again and stays") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.inject({"bridge_fault"});
  rig.run(0.02);
  rig.control.heal("bridge_fault");
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.command(protocol::Command::enable_force);
  rig.run(0.3);
  CHECK(protocol::force_is_on(rig.pose().state));
  CHECK(any_motor_driven(rig.control));
}

TEST_CASE("gimbal and supply are measured again after a transfer that failed for a moment") {
  BoardRig rig;
  rig.run(0.1);
  for (int failure = 0; failure < 10; ++failure) {
    protocol::InjectionRequest fault{"dma_stopped"};
    fault.for_s = 0.5 * static_cast<double>(protocol::samples_stale_s);
    rig.control.inject(fault);
    rig.run(0.03);
  }
  rig.control.supply(20.0);
  rig.control.gimbal({0.7, 0.8, 0.9});
  rig.run(0.3);
  CHECK(rig.pose().supply_dV == doctest::Approx(200).epsilon(0.01));
  for (int i = 0; i < 3; ++i) CHECK(rig.pose().gimbal_rad[i] == doctest::Approx(0.7 + 0.1 * i).epsilon(0.01));
  CHECK(rig.pose().state != State::fault);
  CHECK(rig.control.status().all.at("violations").empty());
}
