// Tests opening an arm by its address. A script replaces the virtual board and prints the ports of the test's servers.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "host/client/device/open_arm.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/host/client/device/fake_control_server.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using nlohmann::json;
using protocol::Parameter;

namespace {

const std::filesystem::path paper_arm = std::filesystem::path(INKWELL_SOURCE_DIRECTORY) / "boards/arms/paper.toml";

/// The program is a fake virtual board that prints the ports of these servers.
class StandIn {
 public:
  StandIn(std::uint16_t usbip_port, std::uint16_t control_port) {
    std::ofstream(program()) << "#!/bin/sh\necho ready usbip=" << usbip_port << " control=" << control_port
                             << "\nwhile :; do sleep 0.01; done\n";
    std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
  }
  device::VirtualBoardOptions options() const { return {.program = program(), .elf = program()}; }

 private:
  std::filesystem::path program() const { return folder_ / "board"; }
  TemporaryDirectory folder_;
};

std::size_t count_of(FakeControlServer& server, const std::string& command) {
  std::size_t count = 0;
  for (const auto& request : server.requests()) count += request.at("command") == command;
  return count;
}

std::string board_time_line(double board_time_s) {
  return json{{"ok", true}, {"board_time_s", board_time_s}}.dump() + "\n";
}

}  // namespace

TEST_CASE("open_arm connects to a server and returns an endpoint with the serial number of the arm") {
  FakeUsbipServer server;
  const auto opened = device::open_arm(device::parse_address("usbip:" + std::to_string(server.port())), {});
  CHECK(opened.endpoint.serial_number == "0123456789ABCDEF01234567");
  CHECK(opened.endpoint.server.port == server.port());
  CHECK_FALSE(opened.board);
  CHECK(server.transactions() == 0);
}

TEST_CASE("a virtual board that open_arm starts gets the parameters of its arm description") {
  FakeUsbipServer usb;
  FakeControlServer control([](const json&) { return board_time_line(0.0); });
  const StandIn board(usb.port(), control.port());
  const auto opened = device::open_arm(device::parse_address("virtual:" + paper_arm.string()), board.options());
  CHECK(opened.board->is_running());
  CHECK(usb.transactions() == 1);
  const auto arm = device::arm_parameters(paper_arm);
  for (const auto& [parameter, value] : arm) CHECK(usb.parameters[parameter] == value);
  CHECK(count_of(control, "stand_by") == 0);
}

TEST_CASE("the arm description is parsed once, and its name is available without the file") {
  const TemporaryDirectory directory;
  FakeUsbipServer usb;
  FakeControlServer control([](const json&) { return board_time_line(0.0); });
  const StandIn board(usb.port(), control.port());
  const auto arm = device::arm_parameters(paper_arm);
  const auto pipe = directory / "arm.toml";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::atomic<bool> is_over = false;
  // Only the first reader of the pipe receives the description; later readers receive an empty file.
  std::thread writer([&] {
    {
      std::ifstream description(paper_arm);
      std::ofstream(pipe) << description.rdbuf();
    }
    while (!is_over) {
      if (const int descriptor = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK); descriptor >= 0) ::close(descriptor);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  device::OpenArm opened;
  CHECK_NOTHROW(opened = device::open_arm(device::parse_address("virtual:" + pipe.string()), board.options()));
  is_over = true;
  writer.join();
  CHECK(opened.arm_name == "D-H arm of the paper");
  for (const auto& [parameter, value] : arm) CHECK(usb.parameters[parameter] == value);
}

TEST_CASE("without an arm description, the arm has no name") {
  FakeUsbipServer usb;
  FakeControlServer control([](const json&) { return board_time_line(0.0); });
  const StandIn board(usb.port(), control.port());
  CHECK(device::open_arm(device::parse_address("virtual"), board.options()).arm_name.empty());
}

TEST_CASE("open_arm puts a paused board on stand-by and runs it until its arm appears") {
  FakeUsbipServer usb;
  usb.product_id = 0x0BAD;
  FakeControlServer control([&](const json& request) {
    if (request.at("command") == "run") usb.product_id = 0x0001;
    return board_time_line(0.0);
  });
  const StandIn board(usb.port(), control.port());
  auto options = board.options();
  options.paused = true;
  const auto opened = device::open_arm(device::parse_address("virtual"), options);
  CHECK(count_of(control, "stand_by") == 1);
  CHECK(count_of(control, "run") == 1);
  CHECK(usb.transactions() == 0);
}

TEST_CASE("a board that shows no arm in two seconds of its time is given up") {
  FakeUsbipServer usb;
  usb.product_id = 0x0BAD;
  std::atomic<int> statuses = 0;
  FakeControlServer control([&](const json&) { return board_time_line(++statuses > 3 ? 2.01 : 2.0); });
  const StandIn board(usb.port(), control.port());
  const auto open = [&] { device::open_arm(device::parse_address("virtual"), board.options()); };
  CHECK(contains(message_of<device::Error>(open), "shows no USB device"));
  CHECK(statuses == 4);
}

TEST_CASE("a board with a locked-up processor immediately causes an error") {
  FakeUsbipServer usb;
  usb.product_id = 0x0BAD;
  FakeControlServer control([&](const json&) {
    return json{{"ok", true}, {"board_time_s", 0.005}, {"locked_up", "The processor has locked up: so it is."}}.dump() +
           "\n";
  });
  const StandIn board(usb.port(), control.port());
  const auto open = [&] { device::open_arm(device::parse_address("virtual"), board.options()); };
  const auto said = message_of<device::Error>(open);
  CHECK(contains(said, "locked up: so it is."));
  CHECK(contains(said, "for this board"));
}

TEST_CASE("an arm description sets the arm's parameters and no others") {
  const auto arm = device::arm_parameters(paper_arm);
  std::size_t expected = 0;
  for (const auto& row : protocol::parameter_table) expected += row.belongs_to_arm;
  CHECK(arm.size() == expected);
  for (const auto& [parameter, value] : arm) CHECK(info(parameter).belongs_to_arm);
  CHECK_THROWS_AS(device::arm_parameters("/nowhere/at/all.toml"), device::Error);
}
