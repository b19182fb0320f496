// Tests the guides on the command line with the flashed firmware; the simulated hand acts as the user.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "boards/arms/description.hpp"
#include "boards/bench_modules/facts.hpp"
#include "boards/omni_driver/facts.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"
#include "host/client/recording/recording.hpp"

#include "tests/system/program.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell::tests;
using namespace inkwell;
using namespace std::chrono_literals;

namespace {

arms::Description simulated_arm() { return arms::read(INKWELL_SOURCE_DIRECTORY "/boards/arms/omni.toml"); }
arms::Motor simulated_motor() { return simulated_arm().motor; }
double simulated_resistance_ohm() {
  return static_cast<double>(simulated_arm().parameters[protocol::Parameter::motor_resistance_1_ohm]);
}

nlohmann::json guide(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--virtual", "--yes", "--json"});
  const auto result = run_program("inkwell", arguments);
  INFO("output: ", result.out, result.err);
  REQUIRE(result.exit_code == 0);
  return nlohmann::json::parse(result.out);
}

}  // namespace

TEST_CASE("current-loop tuning finds the simulated motors within 5 % and its gains work") {
  const auto result = guide({"tune", "current-loop"});
  CHECK(result.at("result") == "finished");
  CHECK(result.at("applied") == false);
  REQUIRE(result.at("motors").size() == 3);
  for (const auto& motor : result.at("motors")) {
    CHECK(motor.at("resistance_ohm").get<double>() ==
          doctest::Approx(simulated_resistance_ohm()).scale(0).epsilon(0.05));
    CHECK(motor.at("inductance_H").get<double>() ==
          doctest::Approx(simulated_motor().inductance_H).scale(0).epsilon(0.05));
    CHECK(std::abs(motor.at("delay_s").get<double>() - 50e-6) < 10e-6);
  }
  REQUIRE(result.at("steps").size() == 6);
  for (const auto& step : result.at("steps")) {
    CHECK(step.at("rise_time_s").get<double>() > 100e-6);
    CHECK(step.at("rise_time_s").get<double>() < 350e-6);
    CHECK(step.at("overshoot").get<double>() < 0.10);
    CHECK(std::abs(step.at("steady_error_A").get<double>()) < 0.01);
  }
}

TEST_CASE("on another board the resistances are the motors' as well, without the shunt of that board") {
  const auto result = guide({"tune", "current-loop", "--board", "bench_modules"});
  CHECK(result.at("board") == "bench_modules");
  for (const auto& motor : result.at("motors")) {
    const double found_ohm = motor.at("resistance_ohm");
    CHECK(motor.at("circuit_resistance_ohm").get<double>() - found_ohm ==
          doctest::Approx(board::bench_modules.shunt_ohm).epsilon(1e-6));
    CHECK(found_ohm == doctest::Approx(simulated_resistance_ohm()).scale(0).epsilon(0.05));
  }
}

TEST_CASE("current-loop tuning saves all pulses, and does not replace a file") {
  const TemporaryDirectory directory;
  const auto file = directory.file("pulses.h5");
  const auto result = guide({"tune", "current-loop", "--motor", "1", "--out", file});
  const auto pulses = recording::read(file);
  CHECK(pulses.information.simulation);
  CHECK(pulses.complete);
  REQUIRE(pulses.marks.size() == 10);  // eight voltage pulses and two current steps
  CHECK(pulses.marks[0].text == "motor 1: 1 V for 10 ms");
  CHECK(pulses.marks[9].text == "motor 1: current step, suggested gains");
  // The settled current follows from the measured resistance, which includes both switches of the bridge.
  CHECK(result.at("motors")[0].at("resistance_includes") == "winding and both switches of the bridge");
  const auto& current_A = pulses.column(protocol::Signal::current_1_A);
  CHECK(*std::ranges::max_element(current_A, [](float a, float b) { return a < b || std::isnan(a); }) > 0.3f);
  const auto again = run_program("inkwell", {"tune", "current-loop", "--virtual", "--yes", "--out", file});
  CHECK(again.exit_code != 0);
  CHECK(again.err.find("exists") != std::string::npos);
}

TEST_CASE("a wider bandwidth rises faster, and is applied when asked") {
  const auto result = guide({"tune", "current-loop", "--motor", "2", "--bandwidth", "1500", "--apply"});
  CHECK(result.at("applied") == true);
  REQUIRE(result.at("steps").size() == 2);
  const double before_s = result.at("steps")[0].at("rise_time_s"), after_s = result.at("steps")[1].at("rise_time_s");
  CHECK(after_s < 0.75 * before_s);
  REQUIRE(result.at("proposals").size() == 3);
  CHECK(result.at("proposals")[2].at("parameter") == "motor_resistance_2_ohm");
  CHECK(result.at("proposals")[2].at("proposed").get<double>() ==
        doctest::Approx(simulated_resistance_ohm()).scale(0).epsilon(0.05));
  CHECK(result.at("proposals")[0].at("proposed").get<double>() ==
        doctest::Approx(simulated_motor().inductance_H * 2 * std::numbers::pi * 1500).scale(0).epsilon(0.05));
}

TEST_CASE("a healthy simulated arm needs no change of directions") {
  const auto result = guide({"check", "directions"});
  CHECK(result.at("result") == "finished");
  CHECK(result.at("proposals").empty());
  REQUIRE(result.at("encoders").size() == 3);
  REQUIRE(result.at("motors").size() == 3);
  for (const auto& motor : result.at("motors")) {
    CHECK(motor.at("turned_by_positive_current_rad").get<double>() > 0.005);
    CHECK(motor.at("turned_by_negative_current_rad").get<double>() < -0.005);
  }
}

TEST_CASE("the connection check reports the supply, the encoders and the buttons") {
  const auto result = guide({"check", "connection"});
  CHECK(result.at("result") == "finished");
  CHECK(std::abs(result.at("device").at("supply_V").get<double>() - board::supply_nominal_V) < 0.5);
  CHECK(result.at("encoders").size() == 3);
  CHECK(result.at("buttons") == nlohmann::json::array({1, 2}));
}

TEST_CASE("calibration of the simulated arm agrees with its description") {
  const auto results = guide({"calibrate", "all", "--quadratic"});
  REQUIRE(results.size() == 3);
  const auto& joints = results[1].at("joints");
  REQUIRE(joints.size() == 3);
  for (const auto& joint : joints) {
    CHECK(joint.at("agrees") == true);
    CHECK(joint.at("found_rad")[1].get<double>() - joint.at("found_rad")[0].get<double>() > 1.5);
  }
  const auto& potentiometers = results[2].at("potentiometers");
  REQUIRE(potentiometers.size() == 3);
  for (const auto& potentiometer : potentiometers) {
    CHECK(potentiometer.at("largest_change_rad").get<double>() < 0.01);
    CHECK(potentiometer.at("ratio")[1].get<double>() > 0.99);
  }
  for (const auto& result : results) CHECK(result.at("proposals").empty());
}

TEST_CASE("a device that is unplugged in the middle of a guide ends it with a sentence, and its motors are off") {
  device::VirtualBoardOptions options;
  device::VirtualBoard board(options);
  auto control = board.control();
  while (!board.find()) std::this_thread::sleep_for(10ms);
  std::optional<ProgramResult> result;
  std::thread guide([&] {
    result = run_program("inkwell", {"tune", "current-loop", "--yes", "--json", "--usbip", board.usbip().text()});
  });
  // Runs until a motor has current during the first pulses. A pulse is longer than a step, so no pulse is missed.
  constexpr double step_s = 0.002, limit_s = 60;
  bool powered = false;
  for (double passed_s = 0; passed_s < limit_s && !powered; passed_s += step_s) {
    control.run(step_s);
    powered = std::abs(control.truth().at("true_current_1_A").get<double>()) > 0.1;
  }
  control.usb(false);
  guide.join();
  CHECK(powered);
  INFO("output: ", result->out, result->err);
  CHECK(result->exit_code == 1);
  CHECK(result->err.find("was disconnected in the step") != std::string::npos);
  const auto json = nlohmann::json::parse(result->out);
  CHECK(json.at("result") == "failed");
  CHECK(json.at("applied") == false);
  control.run(0.2);
  CHECK(std::abs(control.truth().at("true_current_1_A").get<double>()) < 0.02);
}

TEST_CASE("without consent nothing is powered") {
  const auto result = run_program("inkwell", {"tune", "current-loop", "--virtual", "--json"});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("--yes") != std::string::npos);
  CHECK(result.err.find("Motor 1 receives 8 pulses") != std::string::npos);
}

TEST_CASE("a reversed angle range is a usage error") {
  const auto result = run_program("inkwell", {"calibrate", "pots", "--virtual", "--yes", "--yaw-range", "2:-2"});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("is not a range") != std::string::npos);
}
