// Commands that look at the arm from a terminal, beside a board that runs by itself.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/device.hpp>
#include <device/virtual_board.hpp>

#include "program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

/// A board in real time, and the companion beside it.
struct BoardAndCompanion {
  device::VirtualBoard board{device::VirtualBoardOptions{}};
  device::ControlClient control = board.control();

  ProgramResult run(std::vector<std::string> words) {
    words.insert(words.end(), {"--usbip", fmt::format("127.0.0.1:{}", board.usbip_port())});
    return run_program("inkwell", words);
  }
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
