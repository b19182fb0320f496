// Commands that look at the arm from a terminal, beside a board that runs by itself.
#include <doctest/doctest.h>

#include <signal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/device.hpp>
#include <device/virtual_board.hpp>
#include <recording/recording.hpp>

#include <stepped_board.hpp>

#include "program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

/// A board in real time, and the companion beside it.
struct BoardAndCompanion {
  device::VirtualBoard board{device::VirtualBoardOptions{}};
  device::ControlClient control = board.control();

  std::vector<std::string> words(std::vector<std::string> command) const {
    command.insert(command.end(), {"--usbip", fmt::format("127.0.0.1:{}", board.usbip_port())});
    return command;
  }
  ProgramResult run(const std::vector<std::string>& command) { return run_program("inkwell", words(command)); }
  /// Until the board has started, which takes it a part of a second.
  void wait_for_device() {
    while (!board.find()) control.run(0.1);
    control.run(0.5);
    control.resume();
  }
};

}  // namespace

TEST_CASE("a fault is shown with its remedy, and cleared once its cause is gone") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto well = rig.run({"fault"});
  CHECK(well.exit_code == 0);
  CHECK(well.out.starts_with("No fault."));

  rig.control.bridge_fault(true);
  rig.control.run(0.01);
  rig.control.resume();
  const auto shown = rig.run({"fault"});
  CHECK(shown.exit_code == 0);
  CHECK(shown.out.find("A bridge reported") != std::string::npos);
  CHECK(shown.out.find("let the bridges cool") != std::string::npos);
  CHECK(nlohmann::json::parse(rig.run({"fault", "--json"}).out).at("fault") == "bridge_fault");
  const auto again = rig.run({"fault", "clear"});
  CHECK(again.exit_code == 1);
  INFO(again.err);
  CHECK(again.err.find("The fault is there again. bridge_fault: A bridge reported") != std::string::npos);

  rig.control.bridge_fault(false);
  const auto cleared = rig.run({"fault", "clear"});
  CHECK(cleared.exit_code == 0);
  CHECK(cleared.out.starts_with("No fault."));
}

TEST_CASE("the arms that are there are listed by serial number") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto listed = rig.run({"devices", "--json"});
  REQUIRE(listed.exit_code == 0);
  const auto json = nlohmann::json::parse(listed.out);
  REQUIRE(json.size() == 1);
  CHECK(json[0].at("serial_number") == device::Device::open(*rig.board.find())->information().serial_number);
  CHECK(rig.run({"devices"}).out.find(json[0].at("serial_number").get<std::string>()) != std::string::npos);
  CHECK(run_program("inkwell", {"devices", "--virtual"}).exit_code == 2);
}

TEST_CASE("a command switches the force on for as long as it runs, and any other switches it off") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  CHECK(nlohmann::json::parse(rig.run({"force", "--json"}).out).at("force_is_on") == false);
  auto words = rig.words({"force", "on"});
  words.insert(words.begin(), build_directory() + "/inkwell");
  RunningProgram on(words);
  CHECK(on.read_line() == "The force is on.");
  CHECK(on.read_line() == "Ctrl-C switches it off.");
  CHECK(rig.run({"force"}).out == "The force is on.\n");
  SUBCASE("Ctrl-C") {
    kill(on.process(), SIGINT);
    CHECK(on.read_line() == "The force is off.");
    CHECK(on.wait() == 0);
  }
  SUBCASE("another command") {
    const auto off = rig.run({"force", "off"});
    CHECK(off.exit_code == 0);
    CHECK(off.out == "The force is off.\n");
    CHECK(on.wait() == 1);
  }
  SUBCASE("a fault") {
    rig.control.bridge_fault(true);
    CHECK(on.wait() == 1);
    const auto refused = rig.run({"force", "on"});
    CHECK(refused.exit_code == 1);
    CHECK(refused.err.find("The force is off. bridge_fault: A bridge reported") != std::string::npos);
  }
  CHECK(rig.run({"force"}).out.starts_with("The force is off."));
}

TEST_CASE("the force ends by itself after a time of the board") {
  const auto run = run_program("inkwell", {"--virtual", "force", "on", "--seconds", "0.3"});
  CHECK(run.exit_code == 0);
  CHECK(run.out == "The force is on.\nThe force is off.\n");
}

TEST_CASE("a recording switches the force on if asked to, and off at its end") {
  const TemporaryDirectory directory;
  BoardAndCompanion rig;
  rig.wait_for_device();
  // The hand aims 15 mm into the floor of the box.
  rig.control.run(bring_stylus(rig.control,
                               {0.0, 0.0, protocol::info(protocol::Parameter::box_minimum_z_m).default_value - 0.015},
                               0.6) +
                  0.5);
  rig.control.resume();
  const auto largest_A = [&](const char* file, std::vector<std::string> more) {
    std::vector<std::string> words{"record", directory.file(file), "--seconds", "0.5"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = rig.run(words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    float largest = 0;
    const auto recording = recording::read(directory.file(file));
    for (const float current_A : recording.column(protocol::Signal::current_2_A))
      largest = std::max(largest, std::abs(current_A));
    return largest;
  };
  CHECK(largest_A("without.h5", {}) < 0.05f);  // noise of the converter
  CHECK(largest_A("with.h5", {"--force"}) > 0.2f);
  CHECK(rig.run({"force"}).out == "The force is off.\n");
}

TEST_CASE("a recording that is refused leaves the force off") {
  const TemporaryDirectory directory;
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto other = device::Device::open(*rig.board.find());
  other->select_signals(std::vector{protocol::Signal::current_1_A});
  const auto refused = rig.run({"record", directory.file("refused.h5"), "--seconds", "0.1", "--force"});
  CHECK(refused.exit_code == 1);
  CHECK(refused.err.find("scope") != std::string::npos);
  CHECK(rig.run({"force"}).out == "The force is off.\n");
}
