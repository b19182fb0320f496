// The first power-up of a new board on the virtual board: without motors, with one motor, and with unknown motors.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "boards/arms/description.hpp"
#include "host/lab/campaign/handling.hpp"
#include "tests/stepped_board.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using protocol::Command;
using protocol::Fault;
using protocol::Limit;
using protocol::Parameter;
using protocol::SelfTestItem;
using protocol::SelfTestReport;
using protocol::SelfTestResult;
using protocol::State;

const protocol::SelfTestEntry& of(const SelfTestReport& report, SelfTestItem item) {
  return report.entries[static_cast<std::size_t>(item)];
}

/// Writes the description of an Omni with these motors. Its firmware still expects 2.18 ohm and 0.0234 Nm/A. Resistance
/// and inductance of windings with equal copper mass are proportional.
std::string write_arm(const TemporaryDirectory& directory, double resistance_ohm,
                      double torque_constant_Nm_per_A = 0.0234) {
  const std::string path = directory.file("arm.toml");
  std::ifstream omni(INKWELL_SOURCE_DIRECTORY "/boards/arms/omni.toml");
  std::ofstream arm(path);
  for (std::string line; std::getline(omni, line);) {
    const std::string key = line.substr(0, line.find(" ="));
    if (line.starts_with("motor_resistance_"))
      line = fmt::format("{} = {}", key, resistance_ohm);
    else if (line.starts_with("inductance_H"))
      line = fmt::format("{} = {}", key, 0.000238 * resistance_ohm / 2.18);
    else if (line.starts_with("torque_constant_"))
      line = fmt::format("{} = {}", key, torque_constant_Nm_per_A);
    arm << line << '\n';
  }
  return path;
}

void switch_force_on(BoardRig& rig) {
  rig.take_to(free_point_m);
  rig.command(Command::enable_force);
  rig.run(1.0);
}

}  // namespace

TEST_CASE("a board without motors starts, and its bridges, its fault wire and its heartbeat can be tested") {
  BoardRig rig;
  for (const char* motor : {"1", "2", "3"}) rig.control.inject({.fault = "motor_open", .of = motor});
  const SelfTestReport report = self_test_after_reset(rig);
  for (const SelfTestItem item : {SelfTestItem::motor_1, SelfTestItem::motor_2, SelfTestItem::motor_3})
    CHECK(of(report, item).result == SelfTestResult::missing);
  CHECK(rig.pose().fault == Fault::none);
  switch_force_on(rig);
  CHECK(rig.pose().state == State::limited);
  CHECK(rig.pose().limits == static_cast<std::uint8_t>(Limit::motors));
  CHECK(campaign::bridges_drive(rig.control.truth()));
  rig.control.inject({.fault = "bridge_fault", .for_s = 0.01});
  rig.run(0.05);
  CHECK(rig.pose().fault == Fault::bridge_fault);
  rig.command(Command::clear_fault);
  rig.run(0.1);
  CHECK(rig.pose().state == State::ready);
}

TEST_CASE("one connected motor passes the self-test and receives no current for the force") {
  BoardRig rig;
  for (const char* motor : {"1", "3"}) rig.control.inject({.fault = "motor_open", .of = motor});
  const SelfTestReport report = self_test_after_reset(rig);
  CHECK(of(report, SelfTestItem::motor_1).result == SelfTestResult::missing);
  CHECK(of(report, SelfTestItem::motor_2).result == SelfTestResult::passed);
  CHECK(of(report, SelfTestItem::motor_2).figure == doctest::Approx(2.27).epsilon(0.05));
  switch_force_on(rig);
  CHECK(rig.pose().state == State::limited);
  CHECK(largest_current_A(rig.control) < 0.02);
}

TEST_CASE("motors of 1, 6 and 20 ohm are measured by the self-test, and drive the force after the tuning is applied") {
  for (const double resistance_ohm : {1.0, 6.0, 20.0}) {
    CAPTURE(resistance_ohm);
    const TemporaryDirectory directory;
    auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
    options.arm = write_arm(directory, resistance_ohm);
    BoardRig rig(options);
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
    const SelfTestReport report = rig.device->read_self_test();
    CHECK(of(report, SelfTestItem::motor_2).result == SelfTestResult::unknown_motor);
    CHECK(of(report, SelfTestItem::motor_2).figure == doctest::Approx(resistance_ohm).epsilon(0.15));

    rig.device.reset();
    rig.control.resume();
    const std::string port = rig.board.usbip().text();
    const auto tuned = run_program("inkwell", {"tune", "current-loop", "--yes", "--apply", "--json", "--usbip", port});
    INFO(tuned.out, tuned.err);
    REQUIRE(tuned.exit_code == 0);
    const auto guide = nlohmann::json::parse(tuned.out);
    for (const auto& motor : guide.at("motors"))
      CHECK(motor.at("resistance_ohm").get<double>() == doctest::Approx(resistance_ohm).scale(0).epsilon(0.08));
    CHECK(guide.at("proposals").back().at("parameter") == "motors_confirmed");

    const auto test = run_program("inkwell", {"self-test", "--usbip", port});
    INFO(test.out, test.err);
    CHECK(test.exit_code == 0);
    rig.control.stand_by();
    rig.connect();
    switch_force_on(rig);
    CHECK((rig.pose().limits & static_cast<std::uint8_t>(Limit::motors)) == 0);
    CHECK(protocol::force_is_on(rig.pose().state));
  }
}

TEST_CASE("a swapped shunt is reported with its remedy, whether the motors are confirmed or not") {
  BoardRig rig;
  for (const float is_confirmed : {0.0f, 1.0f}) {
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
    rig.set({{Parameter::motors_confirmed, is_confirmed}});
    rig.control.inject({.fault = "shunt_gain", .of = "2", .amount = -1.0});
    const SelfTestReport report = rig.device->self_test();
    CHECK(of(report, SelfTestItem::motor_2).result == SelfTestResult::wrong_sign);
    rig.run(0.05);
    CHECK(rig.pose().fault == Fault::self_test_failed);
    rig.control.heal_all();
    rig.command(Command::clear_fault);
    rig.run(0.2);
  }
}

TEST_CASE("a confirmed board with a missing motor offers a remedy that is possible in this state") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.set({{Parameter::motors_confirmed, 1.0f}});
  rig.control.inject({.fault = "motor_open", .of = "1"});
  rig.device->self_test();
  rig.run(0.05);
  REQUIRE(rig.pose().fault == Fault::self_test_failed);
  CHECK(std::string(info(SelfTestItem::motor_1).remedy).find("set motors_confirmed to 0") != std::string::npos);
  rig.set({{Parameter::motors_confirmed, 0.0f}});
  rig.command(Command::self_test);
  rig.run(0.3);
  CHECK(rig.pose().state == State::ready);
  CHECK(of(rig.device->read_self_test(), SelfTestItem::motor_1).result == SelfTestResult::missing);
}

TEST_CASE("a motor of unknown resistance is measured although its torque constant is unknown too") {
  struct Motor {
    double resistance_ohm, torque_constant_Nm_per_A;
  };
  for (const auto& [motor, parameter_Nm_per_A] :
       {std::pair{Motor{1.0, 0.0234}, 1.0f}, {Motor{6.0, 0.1}, 0.003f}, {Motor{20.0, 0.1}, 1.0f}}) {
    CAPTURE(motor.resistance_ohm);
    CAPTURE(parameter_Nm_per_A);
    const TemporaryDirectory directory;
    auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
    options.arm = write_arm(directory, motor.resistance_ohm, motor.torque_constant_Nm_per_A);
    BoardRig rig(options);
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
    rig.set({{Parameter::torque_constant_1_Nm_per_A, parameter_Nm_per_A},
             {Parameter::torque_constant_2_Nm_per_A, parameter_Nm_per_A},
             {Parameter::torque_constant_3_Nm_per_A, parameter_Nm_per_A}});
    const SelfTestReport report = rig.device->self_test();
    rig.run(0.1);
    CHECK(rig.pose().state == State::ready);
    for (const SelfTestItem item : {SelfTestItem::motor_1, SelfTestItem::motor_2, SelfTestItem::motor_3}) {
      CHECK(of(report, item).result == SelfTestResult::unknown_motor);
      CHECK(of(report, item).figure == doctest::Approx(motor.resistance_ohm).epsilon(0.15));
    }
    switch_force_on(rig);
    CHECK(rig.pose().state == State::limited);
    CHECK(largest_current_A(rig.control) < 0.02);
  }
}

}  // namespace inkwell::tests
