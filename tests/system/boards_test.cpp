// All boards run the same firmware, built with the facts of each board. Tests start, self-test, reference, current loop
// and walls of each board. Tests that need only one board are in other files.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "boards/known/boards.hpp"
#include "protocol/self_test.hpp"
#include "tests/stepped_board.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

namespace inkwell::tests {
namespace {

using protocol::State;

std::string text_of(board::Pin pin) { return std::string(1, 'P') + pin.port + std::to_string(pin.number); }

void check_self_test(BoardRig& rig) {
  const auto report = rig.device->read_self_test();
  for (std::size_t i = 0; i < protocol::self_test_item_count; ++i) {
    INFO("item ", std::string(protocol::self_test_item_table[i].name), ", figure ", report.entries[i].figure);
    CHECK(info(report.entries[i].result).name == info(protocol::SelfTestResult::passed).name);
  }
}

/// Checks that the measured motor currents equal the true currents.
void check_currents(BoardRig& rig) {
  constexpr std::array currents{protocol::Signal::current_1_A, protocol::Signal::current_2_A,
                                protocol::Signal::current_3_A};
  rig.make_active();
  rig.device->select_signals(currents);
  rig.take_to(free_point_m);
  rig.set({{protocol::Parameter::box_minimum_z_m, static_cast<float>(free_point_m[2]) + 0.002f}});
  rig.run(0.3);  // in a wall of two millimeters
  device::ScopeSamples newest;
  while (auto samples = rig.device->read_scope(std::chrono::milliseconds(0))) newest = std::move(*samples);
  REQUIRE(newest.count > 0);
  const auto truth = rig.control.truth();
  double largest_A = 0.0;
  for (std::size_t motor = 0; motor < currents.size(); ++motor) {
    const double true_A = truth.at("true_current_" + std::to_string(motor + 1) + "_A").get<double>();
    const double read_A = newest.values[newest.values.size() - currents.size() + motor];
    CHECK(read_A == doctest::Approx(true_A).epsilon(0.05).scale(0.5));
    largest_A = std::max(largest_A, std::abs(read_A));
  }
  CHECK(largest_A > 0.2);
}

}  // namespace

TEST_CASE("every board starts, passes its self-test, finds its reference, and reads and shows what it is wired to") {
  for (const board::Facts* board : board::known_boards) {
    CAPTURE(board->name);
    auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
    options.board = board->name;
    BoardRig rig(options);
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
    CHECK(rig.device->information().board_name == board->name);
    CHECK(rig.pose().supply_dV == doctest::Approx(180).epsilon(0.02));
    check_self_test(rig);
    CHECK(rig.control.pin(text_of(board->status_led)).level == (board->status_led_shines_when_low ? "low" : "high"));
    for (const bool first : {true, false}) {
      rig.control.buttons(first, !first);
      rig.run(0.05);
      constexpr unsigned inkwell = 4;
      CHECK(rig.pose().switches == (inkwell | (first ? 1u : 2u)));
    }
    check_currents(rig);
  }
}

TEST_CASE("the program shows the board name in text and in JSON") {
  const std::vector<std::string> of_bench{"info", "--virtual", "--board", "bench_modules"};
  const auto text = run_program("inkwell", of_bench);
  INFO(text.err);
  CHECK(text.out.find("board               bench_modules\n") != std::string::npos);
  auto words = of_bench;
  words.push_back("--json");
  const auto json = run_program("inkwell", words);
  REQUIRE(json.exit_code == 0);
  CHECK(nlohmann::json::parse(json.out).at("board") == "bench_modules");
}

TEST_CASE("a flash file that holds a board's firmware gets none of another board") {
  const TemporaryDirectory directory;
  const auto file = directory.file("board.flash");
  const auto board_of = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"info", "--virtual", "--flash", file, "--json"});
    const auto result = run_program("inkwell", words);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.out).at("board").get<std::string>();
  };
  CHECK(board_of({}) == board::default_board.name);  // a new chip
  CHECK(board_of({"--board", "bench_modules"}) == "bench_modules");
  CHECK(board_of({}) == "bench_modules");
  CHECK(board_of({"--board", "omni_driver"}) == "omni_driver");
}

TEST_CASE("the firmware of one board, flashed on another, shows no device and drives no motor") {
  auto options = stepped_board(device::SimulationMode::fast, device::CyclePricing::likely);
  options.elf = build_directory() + "/../board/" + board::image_name(board::bench_modules);
  options.board = board::omni_driver.name;
  device::VirtualBoard board(options);
  auto control = board.control();
  control.run(1.0);
  CHECK_FALSE(board.find());
  CHECK(largest_current_A(control) == 0.0);
}

TEST_CASE("an unknown board name is refused with a list of the known boards") {
  const auto run = run_program("inkwell", {"info", "--virtual", "--board", "feather"});
  CHECK(run.exit_code == 1);
  CHECK(run.err == "inkwell: There is no board with the name feather. Known boards are bench_modules, omni_driver.\n");
  const auto board =
      run_program("virtual-board", {"--elf", build_directory() + "/../board/inkwell.elf", "--board", "feather"});
  CHECK(board.exit_code == 2);
  CHECK(board.err.find("unknown board feather. Known boards: bench_modules, omni_driver.") != std::string::npos);
  // The error message contains no control characters.
  const auto hostile =
      run_program("virtual-board", {"--elf", build_directory() + "/../board/inkwell.elf", "--board", "x\x1B[2J"});
  CHECK(hostile.err.find("unknown board x?[2J.") != std::string::npos);
}

TEST_CASE("the wall of the paper is as stiff, and the current loop as quick, on every other board") {
  for (const board::Facts* board : board::known_boards) {
    if (board == &board::default_board) continue;  // covered by experiment_test.cpp
    const std::string name(board->name);
    CAPTURE(name);
    const TemporaryDirectory directory;
    const auto result = run_program(
        "inkwell", {"experiment", "wall", "--virtual", "--mode", "fast", "--board", name, "--out", directory.path()});
    INFO("output: ", result.out, result.err);
    REQUIRE(result.exit_code == 0);
    const auto summary = nlohmann::json::parse(std::ifstream(directory.file("summary.json")));
    CHECK(summary.at("force_maximum_N") > 1.0);
    CHECK(summary.at("force_law").at("samples_outside_1_percent_and_5_mN") == 0);
    for (const auto& motor : summary.at("current_step").at("motors")) {
      CHECK(motor.at("rise_time_s") < 300e-6);
      CHECK(motor.at("overshoot") < 0.1);
      CHECK(std::abs(motor.at("steady_error_A").get<double>()) < 0.01);
    }
  }
}

}  // namespace inkwell::tests
