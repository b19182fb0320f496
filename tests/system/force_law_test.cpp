// Tests that every table contains the parameters and signals of a user-defined force law. On the board and on the PC,
// the law computes the same force. A division by zero raises a fault.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include <nlohmann/json.hpp>
#include "firmware/force_laws/magnet.hpp"

#include "host/client/device/force_law.hpp"
#include "host/client/device/parameter_file.hpp"
#include "host/client/recording/recording.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using force_laws::magnet;
using protocol::Fault;
using protocol::Parameter;
using protocol::State;

/// Computes the law's force on the PC from the device's parameters.
control::Vector3 magnet_force_N(const protocol::ParameterSet& held, const control::Vector3& position_m,
                                float& distance_m) {
  magnet::Parameters parameters{};
  for (const auto& row : magnet::parameter_rows) parameters.*row.value = held[device::parameter_named(row.name)];
  control::Probe probe;
  probe.position_m = position_m;
  magnet::State state;
  magnet::Signals signals{};
  const auto force_N = magnet::force_N(probe, parameters, state, signals);
  distance_m = signals.distance_m;
  return force_N;
}

/// Runs `inkwell` while board time advances.
int run_beside(BoardRig& rig, std::vector<std::string> words) {
  words.insert(words.begin(), build_directory() + "/inkwell");
  words.insert(words.end(), {"--usbip", rig.board.usbip().text()});
  RunningProgram program(words);
  for (int slices = 0; slices < 100'000; ++slices) {
    rig.run(0.01);
    if (const auto code = program.wait(0s)) return *code;
  }
  return -1;
}

TEST_CASE(
    "the magnet law adds its rows to the tables, produces the force of its file, and adds a signal to a recording") {
  BoardRig rig(std::string("magnet.elf"));
  const auto law = rig.device->information().force_law;
  REQUIRE(law != nullptr);
  CHECK(law->name == "magnet");
  const Parameter strength = device::parameter_named("magnet_strength_N");
  CHECK(info(strength).group == "force law");
  CHECK(info(strength).default_value == 1.0f);
  CHECK(rig.device->parameters()[strength] == 1.0f);
  rig.set({{Parameter::force_ramp_s, 0.0f}});

  CHECK(run_beside(rig, {"parameters", "set", "magnet_strength_N=0.6", "magnet_reach_m=0.03"}) == 0);
  CHECK(rig.device->parameters()[strength] == 0.6f);
  CHECK_THROWS_WITH_AS(rig.device->set_parameters(std::vector<device::ParameterChange>{{strength, 4.0f}}),
                       "The device refused magnet_strength_N = 4: The value is outside the parameter's range. Give a "
                       "number in the parameter's range. Its range is -3 to 3 N.",
                       device::Refused);

  const device::Vector3 beside_m{0.02, 0.01, -0.03};
  rig.take_to(beside_m);
  rig.make_active();
  rig.run(0.3);
  const TemporaryDirectory directory;
  const std::string file = directory.file("magnet.csv");
  CHECK(run_beside(rig, {"record", file, "--seconds", "0.1", "--signals",
                         "position_x_m,position_y_m,position_z_m,force_x_N,force_y_N,force_z_N,magnet_distance_m"}) ==
        0);
  const auto recording = recording::read(file);
  CHECK(recording.remarks.empty());
  CHECK(recording.information.parameters[strength] == 0.6f);
  REQUIRE(recording.size() > 1000);
  using protocol::Signal;
  const auto at = [&](Signal signal, std::size_t i) { return recording.column(signal)[i]; };
  const Signal distance = *protocol::find_signal("magnet_distance_m");
  for (std::size_t i = 0; i < recording.size(); i += 100) {
    float distance_m = 0.0f;
    const auto expected_N = magnet_force_N(
        recording.information.parameters,
        {at(Signal::position_x_m, i), at(Signal::position_y_m, i), at(Signal::position_z_m, i)}, distance_m);
    CHECK(at(distance, i) == doctest::Approx(distance_m).scale(0).epsilon(1e-5));
    CHECK(at(Signal::force_x_N, i) == doctest::Approx(expected_N.x).scale(0).epsilon(1e-4));
    CHECK(at(Signal::force_y_N, i) == doctest::Approx(expected_N.y).scale(0).epsilon(1e-4));
    CHECK(std::fabs(at(Signal::force_x_N, i)) > 0.3f);
  }

  // The file contains a description of each column.
  const auto about = run_program("inkwell", {"replay", file, "--json"});
  CHECK(about.exit_code == 0);
  const auto json = nlohmann::json::parse(about.out);
  CHECK(json.at("parameters").at("magnet_strength_N").get<float>() == 0.6f);
  CHECK(json.at("signals").back().at("name") == "magnet_distance_m");
  CHECK(json.at("remarks").empty());
}

TEST_CASE("each force law of the tree and of the documentation runs as a complete image without fault") {
  std::ifstream list(build_directory() + "/../board/force-law-images.txt");
  std::size_t count = 0;
  for (std::string image; std::getline(list, image); ++count) {
    CAPTURE(image);
    if (image == "quotient.elf") continue;  // force_law_fault_test.cpp provokes its fault
    BoardRig rig(image);
    const auto law = rig.device->information().force_law;
    REQUIRE(law != nullptr);
    CHECK(law->name == (image == "inkwell.elf" ? "box" : std::filesystem::path(image).stem().string()));
    rig.make_active();
    for (const device::Vector3& target_m : {device::Vector3{0.02, 0.01, -0.03}, {-0.02, 0.0, 0.0}, {0.0, 0.06, -0.03}})
      rig.take_to(target_m, 0.3);
    CHECK(protocol::force_is_on(rig.pose().state));
    CHECK(rig.pose().fault == Fault::none);
    const auto report = rig.device->information().report;
    CHECK(report.servo_cycles_longest > 500);
    CHECK(report.servo_overruns == 0);
  }
  CHECK(count >= 7);
}

}  // namespace
}  // namespace inkwell::tests
