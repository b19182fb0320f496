#include "tests/system/hazards.hpp"

#include <doctest/doctest.h>

#include "host/client/device/fault_text.hpp"

#include "tests/system/program.hpp"

namespace inkwell::tests {

using protocol::Parameter;
using protocol::State;

void reconnect(BoardRig& rig) {
  rig.device.reset();
  rig.control.run(0.02);  // until the bus detects the disconnection of the device
  rig.connect();
}

bool any_leg_high(device::ControlClient& control) {
  const auto truth = control.truth();
  bool high = false;
  for (const auto& legs : truth.at("bridge_legs"))
    for (const auto& level : legs) high |= level == "high";
  return high;
}

bool any_leg_high_within(device::ControlClient& control, double time_s) {
  bool high = false;
  for (int i = 0; i < 20; ++i) {
    control.run(time_s / 20);
    high |= any_leg_high(control);
  }
  return high;
}

bool bridges_enabled(device::ControlClient& control) { return control.truth().at("bridges_enabled").get<bool>(); }

void press_into_wall(BoardRig& rig) {
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_minimum_z_m, -0.015f}});
  rig.run(0.1);
  REQUIRE(protocol::force_is_on(rig.pose().state));
  REQUIRE(largest_current_A(rig.control) > 0.1);
  REQUIRE(bridges_enabled(rig.control));
  REQUIRE(any_leg_high_within(rig.control, control_period_s));
}

std::string reported_by_info(BoardRig& rig) {
  rig.device.reset();
  const auto result = run_program("inkwell", {"info", "--usbip", rig.board.usbip().text()});
  CHECK(result.exit_code == 0);
  return result.out;
}

void check_reports(const std::string& text, protocol::Fault fault) {
  INFO("inkwell info: ", text);
  CHECK(text.find(device::fault_line(fault)) != std::string::npos);
}

namespace {
constexpr int of_trial = 1;
}
int restarts(device::ControlClient& control) { return control.status().all.at("resets").get<int>() - of_trial; }
int watchdog_expires(device::ControlClient& control) {
  return control.status().all.at("watchdog_resets").get<int>() - of_trial;
}

}  // namespace inkwell::tests
