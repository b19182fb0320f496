// What keeps a hand safe: no force before the reference, none without a host, bridges off on a fault.
#include <doctest/doctest.h>

#include <elf.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include <board/omni_driver.hpp>
#include <device/fault_text.hpp>

#include "board_rig.hpp"
#include "program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
using protocol::State;

namespace {

/// After a restart of the board: waits until its USB is back and opens the device again.
void reconnect(BoardRig& rig) {
  rig.device.reset();
  rig.control.run(0.02);  // long enough for the bus to see that the device is gone
  rig.connect();
}

constexpr double control_period_s = 1.0 / protocol::servo_rate_Hz;

bool any_leg_high(device::ControlClient& control) {
  const auto truth = control.truth();
  bool high = false;
  for (const auto& legs : truth.at("bridge_legs"))
    for (const auto& level : legs) high |= level == "high";
  return high;
}

/// Looks at the inputs of the bridges at 20 instants over a time; says whether any of them was high at any of them.
bool any_leg_high_within(device::ControlClient& control, double time_s) {
  bool high = false;
  for (int i = 0; i < 20; ++i) {
    control.run(time_s / 20);
    high |= any_leg_high(control);
  }
  return high;
}

bool bridges_enabled(device::ControlClient& control) { return control.truth().at("bridges_enabled").get<bool>(); }

/// The sphere pressed into a wall by the hand: all three bridges switch, and at least one motor has current.
void press_into_wall(BoardRig& rig) {
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_minimum_z_m, -0.015f}});
  rig.run(0.1);
  REQUIRE(rig.pose().state == State::active);
  REQUIRE(largest_current_A(rig.control) > 0.1);
  REQUIRE(bridges_enabled(rig.control));
  REQUIRE(any_leg_high_within(rig.control, control_period_s));
}

/// What `inkwell info` tells a user about the device of this rig.
std::string told_by_info(BoardRig& rig) {
  rig.device.reset();
  const auto result =
      run_program("inkwell", {"info", "--usbip", "127.0.0.1:" + std::to_string(rig.board.usbip_port())});
  CHECK(result.exit_code == 0);
  return result.out;
}

void check_tells(const std::string& text, protocol::Fault fault) {
  INFO("inkwell info: ", text);
  CHECK(text.find(device::fault_line(fault)) != std::string::npos);
}

/// Where the firmware waits for the reset that it has asked for: "dsb", and a branch back to it.
std::uint32_t endless_loop_address() {
  constexpr std::string_view loop = "\xBF\xF3\x4F\x8F\xFC\xE7";
  std::ifstream file(build_directory() + "/../board/inkwell.elf", std::ios::binary);
  const std::string image{std::istreambuf_iterator<char>(file), {}};
  Elf32_Ehdr header;
  REQUIRE(image.size() > sizeof header);
  std::memcpy(&header, image.data(), sizeof header);
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    Elf32_Phdr segment;
    std::memcpy(&segment, image.data() + header.e_phoff + i * sizeof segment, sizeof segment);
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_X) == 0) continue;
    for (std::uint32_t offset = 0; offset + loop.size() <= segment.p_filesz; offset += 2)
      if (image.compare(segment.p_offset + offset, loop.size(), loop) == 0) return segment.p_paddr + offset;
  }
  FAIL("the firmware holds no endless loop to jump to");
  return 0;
}

}  // namespace

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

  // Back in the inkwell it learns where it is.
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

TEST_CASE("a supply that fails switches the bridges off and says so") {
  BoardRig rig;
  rig.make_active();
  rig.control.supply(9.0);  // the board's capacitors hold the bridges up for a while
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
  rig.control.bridge_fault(true);
  rig.control.run(1.5 * control_period_s);  // until the next control interrupt, and for as long as that may take
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  rig.run(0.02);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::bridge_fault);
  CHECK(largest_current_A(rig.control) < 0.02);

  // While the cause lasts the fault cannot be cleared.
  rig.command(protocol::Command::clear_fault);
  rig.run(0.05);
  CHECK(rig.pose().state == State::fault);
  rig.control.bridge_fault(false);
  rig.run(0.05);
  CHECK(rig.pose().state == State::fault);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));

  rig.control.bridge_fault(true);
  rig.run(0.05);
  check_tells(told_by_info(rig), protocol::Fault::bridge_fault);
}

TEST_CASE("a processor fault with the bridges on switches them off first, and is told after the restart") {
  BoardRig rig(device::SimulationMode::exact);
  press_into_wall(rig);
  constexpr std::uint32_t nothing_there = 0x60000000;
  rig.control.jump(nothing_there);
  const auto restarts = [&] { return rig.control.status().all.at("resets").get<int>(); };
  constexpr double step_s = 50e-9;
  for (int step = 0; step < 20 && bridges_enabled(rig.control); ++step) rig.control.run(step_s);
  rig.control.run(5 * step_s);  // the writes that switch both timers' outputs off cross to APB2
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high(rig.control));
  CHECK(restarts() == 0);  // so it was the handler that switched them off, not the reset
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));
  CHECK_FALSE(any_leg_high_within(rig.control, 0.02));
  CHECK(largest_current_A(rig.control) < 0.02);
  CHECK(restarts() == 1);
  CHECK(rig.control.status().all.at("watchdog_resets") == 0);

  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::processor_fault);
  check_tells(told_by_info(rig), protocol::Fault::processor_fault);
}

TEST_CASE("firmware that hangs with the bridges on is restarted by its watchdog, and says so") {
  BoardRig rig;
  press_into_wall(rig);
  rig.control.jump(endless_loop_address());
  rig.control.run(0.04);  // the slowest watchdog of the data sheet bites after 38 ms
  CHECK(rig.control.status().all.at("watchdog_resets") == 1);
  CHECK_FALSE(bridges_enabled(rig.control));
  CHECK_FALSE(any_leg_high_within(rig.control, 0.02));
  CHECK(largest_current_A(rig.control) < 0.02);

  reconnect(rig);
  rig.run(0.3);
  CHECK(rig.pose().state == State::fault);
  CHECK(rig.pose().fault == protocol::Fault::watchdog);
  check_tells(told_by_info(rig), protocol::Fault::watchdog);
}
