// Two arms with different serial numbers can be used at the same time without interference.
#include <doctest/doctest.h>

#include <array>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "boards/known/boards.hpp"
#include "tests/stepped_board.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::Parameter;
using protocol::Signal;
using protocol::State;

device::VirtualBoardOptions individual(std::uint64_t seed, const board::Facts& board) {
  auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
  options.seed = seed;
  options.board = board.name;
  return options;
}

/// The two devices have different kinds of boards.
struct TwoArms {
  BoardRig first{individual(1, board::omni_driver)}, second{individual(2, board::bench_modules)};
  std::string first_number = first.device->information().serial_number,
              second_number = second.device->information().serial_number;
};

/// Returns the newest sample of the selected signal.
float newest(device::Device& device) {
  float value = 0.0f;
  std::size_t count = 0;
  while (const auto samples = device.read_scope(0ms)) {
    count += samples->count;
    value = samples->values.back();
  }
  CHECK(count > 0);
  return value;
}

}  // namespace

TEST_CASE("two arms: force, parameters, scope and fault of one are not those of the other") {
  TwoArms arms;
  REQUIRE(arms.first_number != arms.second_number);
  for (BoardRig* rig : {&arms.first, &arms.second}) {
    rig->take_to(free_point_m);
    rig->run_until([](const auto& pose) { return pose.state == State::ready; });
    rig->device->select_signals(std::array{Signal::force_x_N});
  }
  arms.first.make_active();
  arms.first.set({{Parameter::wall_stiffness_N_per_m, 444.0f}});
  for (int millisecond = 0; millisecond < 300; ++millisecond) {
    arms.first.push({.force_N = {0.5f, 0.0f, 0.0f}});
    arms.second.control.run(0.001);
  }
  CHECK(newest(*arms.first.device) == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(newest(*arms.second.device) == 0.0f);
  CHECK(largest_current_A(arms.first.control) > 0.02);
  CHECK(largest_current_A(arms.second.control) == doctest::Approx(0.0));
  CHECK(arms.second.pose().state == State::ready);
  CHECK(arms.second.device->parameters()[Parameter::wall_stiffness_N_per_m] != 444.0f);

  arms.first.control.inject({"bridge_fault"});
  arms.first.run(0.05);
  arms.second.run(0.05);
  CHECK(arms.first.pose().state == State::fault);
  CHECK(arms.second.pose().state == State::ready);
}

TEST_CASE("two arms: each may have a program that drives it") {
  TwoArms arms;
  arms.first.device->claim();
  CHECK_NOTHROW(arms.second.device->claim());
  const auto other = device::Device::open(*arms.first.board.find());
  CHECK_THROWS_AS(other->claim(), device::InUse);
}

TEST_CASE("two arms: commands list, record and switch the force of the one that they name, at the same time") {
  const TemporaryDirectory directory;
  device::VirtualBoard boards[] = {
      device::VirtualBoard{{.board = "omni_driver", .seed = 1}},
      device::VirtualBoard{{.board = "bench_modules", .seed = 2}},
  };
  const auto words = [&](unsigned i, std::vector<std::string> command) {
    command.insert(command.end(), {"--usbip", boards[i].usbip().text()});
    return command;
  };
  std::string numbers[2];
  for (unsigned i : {0u, 1u}) {
    auto control = boards[i].control();
    while (!boards[i].find()) control.run(0.1);
    control.run(0.5);
    control.resume();
    const auto listed = run_program("inkwell", words(i, {"devices", "--json"}));
    REQUIRE(listed.exit_code == 0);
    numbers[i] = nlohmann::json::parse(listed.out)[0].at("serial_number");
  }
  CHECK(numbers[0] != numbers[1]);

  const auto record = [&](unsigned i) {
    auto line = words(i, {"record", directory.file(fmt::format("{}.h5", i)), "--seconds", "0.3"});
    line.insert(line.begin(), build_directory() + "/inkwell");
    return line;
  };
  RunningProgram first(record(0)), second(record(1));
  CHECK(first.wait() == 0);
  CHECK(second.wait() == 0);
  for (unsigned i : {0u, 1u}) {
    const auto printed = run_program("inkwell", {"replay", directory.file(fmt::format("{}.h5", i)), "--json"});
    REQUIRE(printed.exit_code == 0);
    CHECK(nlohmann::json::parse(printed.out).at("serial_number") == numbers[i]);
  }

  auto on_words = words(0, {"force", "on"});
  on_words.insert(on_words.begin(), build_directory() + "/inkwell");
  RunningProgram on(on_words);
  CHECK(on.read_line() == "The force is on.");
  CHECK(run_program("inkwell", words(0, {"force"})).out == "The force is on.\n");
  CHECK(run_program("inkwell", words(1, {"force"})).out.starts_with("The force is off."));
  CHECK(run_program("inkwell", words(1, {"force", "off"})).exit_code == 0);
  CHECK(run_program("inkwell", words(0, {"force"})).out == "The force is on.\n");
}

TEST_CASE("a serial number and a server are two ways to name an arm, and one is enough") {
  const auto run = run_program("inkwell", {"info", "--usbip", "127.0.0.1:3240", "--serial", "1"});
  CHECK(run.exit_code == 2);
  CHECK(run.err.find("--serial") != std::string::npos);
}

}  // namespace inkwell::tests
