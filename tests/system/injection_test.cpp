// Tests fault injection into the virtual board through control socket, command line and script.
#include <doctest/doctest.h>

#include <fstream>

#include "tests/temporary_directory.hpp"

#include "tests/system/hazards.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::State;

namespace {

std::string refusal_of(device::ControlClient& control, const protocol::InjectionRequest& fault) {
  try {
    control.inject(fault);
  } catch (const device::Error& error) {
    return error.what();
  }
  return "accepted";
}

ProgramResult run_board(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"--elf", build_directory() + "/../board/inkwell.elf", "--seconds", "0.002"});
  return run_program("virtual-board", arguments);
}

}  // namespace

TEST_CASE("a fault from the control socket starts at its time, is listed, is detected and heals") {
  BoardRig rig;
  rig.make_active();
  const double begin_s = rig.board_time_s();
  CHECK(rig.control.inject({.fault = "bridge_fault", .after_s = 0.0123, .for_s = 0.05}).at_s ==
        doctest::Approx(begin_s + 0.0123));
  rig.control.run(0.0122);
  CHECK(rig.control.status().all.at("injected").empty());
  const auto planned = rig.control.injections().faults;
  REQUIRE(planned.size() == 1);
  CHECK_FALSE(planned[0].has_come);
  CHECK(planned[0].at_s == doctest::Approx(begin_s + 0.0123));
  CHECK(*planned[0].until_s == doctest::Approx(begin_s + 0.0623));
  CHECK(bridges_enabled(rig.control));
  rig.control.run(0.0001 + 2 * control_period_s);
  const auto injected = rig.control.truth().at("injected");
  REQUIRE(injected.size() == 1);
  CHECK(injected[0].at("fault") == "bridge_fault");
  CHECK(injected[0].at("since_s").get<double>() == doctest::Approx(begin_s + 0.0123).epsilon(1e-5));
  CHECK_FALSE(bridges_enabled(rig.control));
  rig.run(0.06);
  CHECK(rig.control.status().all.at("injected").empty());
  CHECK(rig.pose().fault == protocol::Fault::bridge_fault);
  rig.command(protocol::Command::clear_fault);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });

  rig.control.inject({.fault = "shunt_high", .of = "2"});
  rig.control.inject({.fault = "supply_sag", .amount = 9.0});
  CHECK(rig.control.status().all.at("injected").size() == 2);
  CHECK(rig.control.status().all.at("injected")[1].at("amount") == 9.0);
  rig.control.heal("shunt_high");
  CHECK(rig.control.status().all.at("injected").size() == 1);
  CHECK_THROWS_WITH_AS(rig.control.heal("shunt_high", "2"), doctest::Contains("shunt_high 2 is not active or planned"),
                       device::Error);
  CHECK_THROWS_WITH_AS(rig.control.heal("supply_cut"), doctest::Contains("supply_cut is not active or planned"),
                       device::Error);
  rig.control.heal_all();
  CHECK(rig.control.status().all.at("injected").empty());
}

TEST_CASE("the control socket relates control periods to board time") {
  BoardRig rig;
  rig.make_active();
  const auto put_in = rig.control.inject({.fault = "bridge_fault", .after_s = 0.00731});
  rig.run(0.05);
  const auto box = rig.device->black_box();
  REQUIRE(box.fault == protocol::Fault::bridge_fault);
  const auto now = rig.control.injections();
  const double noticed_s = now.period_at_s - static_cast<double>(now.period - box.fault_periods) * control_period_s;
  CHECK(noticed_s > put_in.at_s - control_period_s);
  CHECK(noticed_s < put_in.at_s + 2 * control_period_s);
}

TEST_CASE("the control socket refuses an invalid fault with a sentence") {
  BoardRig rig;
  CHECK(refusal_of(rig.control, {.fault = "nothing"}).find("there is no fault \"nothing\"") != std::string::npos);
  CHECK(refusal_of(rig.control, {.fault = "motor_open"}).find("motor_open needs a location") != std::string::npos);
  CHECK(refusal_of(rig.control, {.fault = "motor_open", .of = "9"}).find("is not a valid motor") != std::string::npos);
  CHECK(refusal_of(rig.control, {.fault = "supply_sag", .amount = 99.0}).find("outside 0 to 18") != std::string::npos);
  CHECK(refusal_of(rig.control, {.fault = "supply_cut", .after_s = -1.0}).find("outside 0 to") != std::string::npos);
  CHECK(rig.control.status().all.at("injected").empty());
}

TEST_CASE("faults on the command line and in a script; a wrong one ends the program before it runs") {
  const TemporaryDirectory directory;
  const std::string script = (directory / "faults").string();
  std::ofstream(script) << "# weak\nsupply_sag=9@0.001\n";
  CHECK(run_board({"--inject", "motor_open:1", "--inject", "logic_sag=1.5@0.001", "--inject-from", script}).exit_code ==
        0);
  const auto wrong = run_board({"--inject", "motor_open:4"});
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.err.find("--inject: \"4\" is not a valid motor; use one of these: 1, 2, 3") != std::string::npos);
  std::ofstream(script) << "\nmotor_shut:1\n";
  const auto wrong_line = run_board({"--inject-from", script});
  CHECK(wrong_line.exit_code == 2);
  CHECK(wrong_line.err.find("line 2: there is no fault \"motor_shut\"") != std::string::npos);
  CHECK(run_board({"--inject", "ram_bit:0x60000000"}).exit_code == 1);
}
