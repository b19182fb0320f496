// The board's self-test on the virtual board. The self-test detects faults that no other check detects. Healthy boards
// pass in every position, and the hand feels hardly any force.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/stepped_board.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/hazards.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::Fault;
using protocol::SelfTestItem;
using protocol::SelfTestReport;
using protocol::SelfTestResult;
using protocol::State;

const protocol::SelfTestEntry& of(const SelfTestReport& report, SelfTestItem item) {
  return report.entries[static_cast<std::size_t>(item)];
}

std::vector<std::string> with_result(const SelfTestReport& report, SelfTestResult result) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < protocol::self_test_item_count; ++i)
    if (report.entries[i].result == result) names.emplace_back(protocol::self_test_item_table[i].name);
  return names;
}
std::vector<std::string> failed(const SelfTestReport& report) { return with_result(report, SelfTestResult::failed); }

void check_passed(const SelfTestReport& report) {
  CHECK(report.tests_ended >= 1);
  for (std::size_t i = static_cast<std::size_t>(SelfTestItem::current_offsets); i < protocol::self_test_item_count;
       ++i) {
    INFO("item ", std::string(protocol::self_test_item_table[i].name), ", figure ", report.entries[i].figure);
    CHECK(info(report.entries[i].result).name == info(SelfTestResult::passed).name);
  }
}

/// The board stores that its motors are installed and measured.
void store_confirmed_motors(BoardRig& rig) {
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.set({{protocol::Parameter::motors_confirmed, 1.0f}});
  rig.command(protocol::Command::store_parameters);
  rig.run(0.3);
}

struct FaultCase {
  const char* fault;
  const char* of;
  double amount;  ///< 0: default of the table
  std::vector<std::string> items;
  bool takes_force = true;
};

protocol::InjectionRequest injection(const FaultCase& the_case) {
  protocol::InjectionRequest request{.fault = the_case.fault, .of = the_case.of};
  if (the_case.amount != 0.0) request.amount = the_case.amount;
  return request;
}

const std::vector<FaultCase>& silent_faults() {
  static const std::vector<FaultCase> cases{
      {"motor_shorted", "1", 0.5, {"motor_1"}},
      {"motor_shorted", "3", 0.5, {"motor_3"}},
      {"shunt_gain", "2", 0.5, {"motor_2"}},
      {"shunt_gain", "2", 2.0, {"motor_2"}},
      {"shunt_frozen", "1", 0, {"motor_1"}},
      {"motor_open", "1", 0, {"motor_1"}},
      {"motor_open", "3", 0, {"motor_3"}},
      {"leg_open", "1A", 0, {"motor_1"}},
      {"leg_open", "2B", 0, {"motor_2"}},
      {"leg_slow", "2A", 0.5e-6, {"bridge_2"}, false},
      {"leg_slow", "3B", 0.5e-6, {"bridge_3"}, false},
      {"wires_shorted", "PC0+PC1", 0, {"motor_1", "motor_2", "current_wires"}},
      {"wire_open", "encoders[0].a", 0, {"encoder_1_a"}},
      {"wire_open", "encoders[0].b", 0, {"encoder_1_b"}},
      {"wire_open", "encoders[1].a", 0, {"encoder_2_a"}},
      {"wire_open", "encoders[1].b", 0, {"encoder_2_b"}},
      {"wire_open", "encoders[2].a", 0, {"encoder_3_a"}},
      {"wire_open", "encoders[2].b", 0, {"encoder_3_b"}},
      {"wire_open", "bridge_fault_tim1", 0, {"bridge_fault_tim1"}},
      {"wire_open", "bridge_fault_tim8", 0, {"bridge_fault_tim8"}},
      {"wire_open", "gimbal[0]", 0, {"gimbal_1"}, false},
      {"wire_low", "gimbal[1]", 0, {"gimbal_2"}, false},
      {"wire_high", "gimbal[2]", 0, {"gimbal_3"}, false},
  };
  return cases;
}

}  // namespace

TEST_CASE("a board that starts has tested itself, and passes on command where it stands") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  check_passed(rig.device->read_self_test());
  CHECK(rig.device->read_self_test().tests_begun == 1);
  CHECK(of(rig.device->read_self_test(), SelfTestItem::flash).result == SelfTestResult::passed);
  CHECK(of(rig.device->read_self_test(), SelfTestItem::ram).result == SelfTestResult::passed);
  CHECK(of(rig.device->read_self_test(), SelfTestItem::watchdog).result == SelfTestResult::passed);
  CHECK(of(rig.device->read_self_test(), SelfTestItem::analog_supply).figure == doctest::Approx(3.3).epsilon(0.01));
  const auto report = rig.device->self_test();
  check_passed(report);
  CHECK(report.tests_ended == 2);
  MESSAGE("simulation: motors of ", of(report, SelfTestItem::motor_1).figure, ", ",
          of(report, SelfTestItem::motor_2).figure, ", ", of(report, SelfTestItem::motor_3).figure,
          " ohm, bridges take ", of(report, SelfTestItem::bridge_1).figure, ", ",
          of(report, SelfTestItem::bridge_2).figure, ", ", of(report, SelfTestItem::bridge_3).figure, " V");
  rig.run(0.05);
  CHECK(rig.pose().state == State::ready);
}

TEST_CASE("the self-test of motors that are not confirmed ends within a fifteenth of a second") {
  auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
  options.strict = true;
  device::VirtualBoard board(options);
  auto control = board.control();
  double ready_s = 0.0;
  while (control.truth().at("bridges_driven_until_s").get<double>() == 0.0 && ready_s < 1.0) {
    control.run(0.001);
    ready_s = control.status().board_time_s;
  }
  control.run(0.1);
  const double driven_until_s = control.truth().at("bridges_driven_until_s").get<double>();
  MESSAGE("simulation: the pulses go from ", ready_s, " to ", driven_until_s, " s after the start");
  CHECK(driven_until_s < 0.22);
  CHECK(driven_until_s - ready_s < 1.0 / 15);
}

TEST_CASE("the self-test on command detects each fault that no other check detects, and passes after the repair") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.set({{protocol::Parameter::motors_confirmed, 1.0f}});
  for (const FaultCase& the_case : silent_faults()) {
    INFO(the_case.fault, " ", the_case.of, " ", the_case.amount);
    rig.control.inject(injection(the_case));
    rig.run(0.15);
    CHECK(rig.pose().state == State::ready);  // not detected by any other check
    const auto on_command = rig.device->self_test();
    CHECK(fmt::format("{}", fmt::join(failed(on_command), " ")) == fmt::format("{}", fmt::join(the_case.items, " ")));
    rig.run(0.02);
    CHECK(rig.pose().fault == (the_case.takes_force ? Fault::self_test_failed : Fault::none));
    rig.control.heal_all();
    rig.run(0.15);
    CHECK(rig.pose().fault == (the_case.takes_force ? Fault::self_test_failed : Fault::none));
    check_passed(rig.device->self_test());
    rig.run(0.02);
    CHECK(rig.pose().state == State::ready);
  }
}

TEST_CASE("the self-test after a reset detects silent faults and blocks the force until they are repaired") {
  BoardRig rig;
  store_confirmed_motors(rig);
  for (const FaultCase& the_case : silent_faults()) {
    if (the_case.of != std::string("1") && the_case.of != std::string("encoders[1].b") &&
        the_case.of != std::string("bridge_fault_tim1"))
      continue;
    INFO(the_case.fault, " ", the_case.of, " ", the_case.amount);
    rig.control.inject(injection(the_case));
    const auto report = self_test_after_reset(rig);
    CHECK(fmt::format("{}", fmt::join(failed(report), " ")) == fmt::format("{}", fmt::join(the_case.items, " ")));
    CHECK(rig.pose().fault == Fault::self_test_failed);
    rig.command(protocol::Command::enable_force);
    rig.run(0.05);
    CHECK(rig.pose().fault == Fault::self_test_failed);
    rig.command(protocol::Command::clear_fault);
    rig.run(0.1);
    CHECK(rig.pose().fault == Fault::self_test_failed);
    rig.control.heal_all();
    rig.command(protocol::Command::clear_fault);
    rig.run(0.1);
    CHECK(rig.pose().fault == Fault::none);
    CHECK(rig.pose().state != State::testing);
  }
}

TEST_CASE("healthy boards pass the self-test for any seed and pose, held, released, or in a moving hand") {
  constexpr int seeds = 20;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    INFO("seed ", seed);
    BoardRig rig(device::SimulationMode::fast, seed);
    check_passed(rig.device->read_self_test().tests_ended == 1 ? rig.device->read_self_test()
                                                               : rig.device->self_test());
    const auto part = [&](std::uint64_t step) { return static_cast<double>(seed * step % 20) / 20.0 - 0.5; };
    rig.take_to({0.08 * part(3), 0.08 * part(7), -0.03 + 0.06 * part(11)}, 0.3);
    check_passed(rig.device->self_test());
    if (seed % 4 == 0) rig.control.hand({});
    if (seed % 4 == 1) rig.control.hand_path({{0.0, {0.0, 0.0, -0.03}}, {0.15, {0.05, 0.03, 0.0}}});
    rig.run(0.05);
    const auto moving = rig.device->self_test();
    CHECK(failed(moving).empty());
    rig.run(0.02);
    CHECK(rig.pose().fault == Fault::none);
  }
}

TEST_CASE("motors that are 100 K hotter pass, and so do supplies of 13 V and 23 V") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  for (const char* motor : {"1", "2", "3"}) rig.control.inject({.fault = "motor_hot", .of = motor, .amount = 100.0});
  for (const double supply_V : {18.0, 13.0, 23.0}) {
    rig.control.supply(supply_V);
    rig.run(0.2);
    INFO("hot, ", supply_V, " V");
    check_passed(rig.device->self_test());
  }
  rig.control.heal_all();
  for (const double supply_V : {13.0, 23.0}) {
    rig.control.supply(supply_V);
    rig.run(0.2);
    INFO(supply_V, " V");
    check_passed(rig.device->self_test());
  }
}

TEST_CASE("healthy boards with very small stored current limits pass the self-test at start-up, at rest or in motion") {
  BoardRig rig;
  rig.take_to({0.02, 0.02, -0.02});
  rig.set({{protocol::Parameter::current_limit_1_A, 0.01f},
           {protocol::Parameter::current_limit_2_A, 0.155f},
           {protocol::Parameter::current_limit_3_A, 0.05f}});
  rig.command(protocol::Command::store_parameters);
  rig.run(0.3);
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    const double side_m = i % 2 == 0 ? 0.05 : -0.05;
    rig.control.hand_path({{0.0, {-side_m, 0.0, -0.03}}, {0.3 + 0.02 * i, {side_m, side_m, -0.02}}});
    rig.run(0.2);
    const auto report = self_test_after_reset(rig);
    CHECK(fmt::format("{}", fmt::join(failed(report), " ")).empty());
    CHECK(rig.pose().fault == Fault::none);
    CHECK(rig.device->parameters()[protocol::Parameter::current_limit_1_A] == 0.01f);
  }
}

TEST_CASE("the self-test detects a half-shorted motor even if all motors are hot") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.set({{protocol::Parameter::motors_confirmed, 1.0f}});
  for (const char* motor : {"1", "2", "3"}) rig.control.inject({.fault = "motor_hot", .of = motor, .amount = 100.0});
  rig.control.inject({.fault = "motor_shorted", .of = "2", .amount = 0.5});
  CHECK(failed(rig.device->self_test()) == std::vector<std::string>{"motor_2"});
}

TEST_CASE("the self-test of a shaken arm passes or reports motion, and never fails") {
  BoardRig rig;
  rig.take_to(free_point_m);
  rig.control.hand({true, free_point_m, 4000, 30});
  std::vector<device::HandWaypoint> path{{0.0, free_point_m}};
  for (int i = 1; i <= 60; ++i)
    path.push_back({i * 0.045,
                    {free_point_m[0] + (i % 2 ? 0.05 : -0.05), free_point_m[1] + (i % 2 ? 0.03 : -0.02),
                     free_point_m[2] + (i % 2 ? 0.02 : -0.02)}});
  rig.control.hand_path(path);
  int passed = 0;
  constexpr int tests = 10;
  for (int i = 0; i < tests; ++i) {
    rig.run(0.03);
    const auto report = rig.device->self_test();
    CHECK(failed(report).empty());
    passed += with_result(report, SelfTestResult::moved).empty();
  }
  MESSAGE("simulation: shaken to and fro, ", passed, " of ", tests, " tests came to a result");
  rig.run(0.02);
  CHECK(rig.pose().fault == Fault::none);
}

TEST_CASE("the hand hardly feels it") {
  BoardRig rig;
  rig.take_to(free_point_m);
  rig.control.meter_start();
  check_passed(rig.device->self_test());
  const auto felt = rig.control.meter_read();
  MESSAGE("simulation: the hand gets at most ", felt.peak_force_N, " N, ", 1e3 * felt.energy_J, " mJ, and is moved by ",
          1e3 * felt.travel_m, " mm");
  CHECK(felt.peak_force_N > 0.1);  // a force was measured
  CHECK(felt.peak_force_N < 1.5);
  CHECK(felt.travel_m < 0.0005);
  CHECK(felt.energy_J < 0.001);
}

TEST_CASE("without a supply the self-test is aborted and reports this, and it runs when a supply is present") {
  BoardRig rig;
  rig.control.inject({"supply_cut"});
  rig.control.run(0.5);
  const auto report = self_test_after_reset(rig);
  CHECK(rig.pose().fault == Fault::supply_low);
  CHECK(report.tests_ended == 0);
  CHECK(of(report, SelfTestItem::motor_1).result == SelfTestResult::broken_off);
  CHECK_THROWS_WITH_AS(rig.device->self_test(), doctest::Contains("inkwell fault"), device::Error);
  rig.control.heal_all();
  rig.run(0.5);
  rig.command(protocol::Command::clear_fault);
  rig.run(0.2);
  CHECK(rig.pose().fault == Fault::none);
  check_passed(rig.device->read_self_test());
}

TEST_CASE("the command shows each item with its figure, and fails with the remedy if one has failed") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.set({{protocol::Parameter::motors_confirmed, 1.0f}});
  rig.device.reset();
  rig.control.resume();
  const std::string port = rig.board.usbip().text();
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"self-test", "--usbip", port};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program("inkwell", arguments);
  };
  const auto well = run({});
  CHECK(well.exit_code == 0);
  CHECK(well.out.find("motor_2             passed      2.") != std::string::npos);
  rig.control.inject({.fault = "motor_open", .of = "2"});
  CHECK(run({"--last"}).exit_code == 0);
  const auto open = run({});
  CHECK(open.exit_code == 1);
  CHECK(open.out.find("motor_2 failed, and the force stays off.") != std::string::npos);
  const auto json = nlohmann::json::parse(run({"--last", "--json"}).out);
  CHECK(json.at("well") == false);
  CHECK(json.at("items").at(17).at("item") == "motor_2");
  const auto fault = run_program("inkwell", {"fault", "--usbip", port});
  INFO(fault.out, fault.err);
  CHECK(fault.out.find("that the force needs: motor_2. If the resistance is too high, check the half bridges") !=
        std::string::npos);
  CHECK(json.at("items").at(17).at("result") == "failed");
  CHECK(json.at("items").at(16).at("figure").get<double>() == doctest::Approx(2.3).epsilon(0.1));
  CHECK(json.at("items").at(5).at("figure").is_null());

  // `fault clear` repeats the self-test and waits for its result.
  const auto clear = [&] { return run_program("inkwell", {"fault", "clear", "--usbip", port}); };
  const auto again = clear();
  CHECK(again.exit_code == 1);
  CHECK(again.err.find("The board has raised the fault again. self_test_failed: ") != std::string::npos);
  CHECK(again.err.find("that the force needs: motor_2.") != std::string::npos);
  rig.control.heal_all();
  const auto cleared = clear();
  CHECK(cleared.exit_code == 0);
  CHECK(cleared.out.starts_with("No fault."));
  CHECK(cleared.out.find("The device is testing") == std::string::npos);
}

}  // namespace inkwell::tests
