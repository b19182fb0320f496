// Tests the list of arms, its changes, and the time limit of opening.
#include <doctest/doctest.h>

#include <arpa/inet.h>
#include <sys/socket.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <thread>
#include <vector>

#include <inkwell/inkwell.h>
#include "host/client/local/descriptor.hpp"
#include "tests/dropins/board.hpp"
#include "tests/environment.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

std::size_t arms_on_usb() {
  std::size_t count = 99;
  REQUIRE(inkwell_list_devices(nullptr, 0, &count) == INKWELL_OK);
  return count;
}

TEST_CASE("a stale or misspelled INKWELL_DEVICE does not hide the arms on USB") {
  const std::size_t on_usb = arms_on_usb();
  for (const char* const address : {"usbip:127.0.0.1:1", "usbip:nowhere", "virtual?nonsense=1", "no such number"}) {
    CAPTURE(address);
    const Environment environment("INKWELL_DEVICE", address);
    std::size_t count = 99;
    CHECK_MESSAGE(inkwell_list_devices(nullptr, 0, &count) == INKWELL_OK, std::string(inkwell_error_text()));
    CHECK(count == on_usb);
  }
  const Environment environment("INKWELL_DEVICE", "virtual");
  std::vector<inkwell_device> devices(on_usb + 1);
  std::size_t count = 0;
  REQUIRE(inkwell_list_devices(devices.data(), devices.size(), &count) == INKWELL_OK);
  CHECK(count == on_usb + 1);
  CHECK(devices.back().is_virtual == 1);
}

TEST_CASE("a program can wait until an arm appears or disappears") {
  std::optional<Board> board(std::in_place);
  std::vector<inkwell_device> devices(8);
  std::size_t count = 0;
  REQUIRE(inkwell_wait_for_devices(10, devices.data(), devices.size(), &count) == INKWELL_OK);
  const std::size_t all = count;
  CHECK(devices[all - 1].address == board->address);
  CHECK(inkwell_wait_for_devices(0, devices.data(), devices.size(), &count) == INKWELL_TIMED_OUT);
  CHECK(inkwell_wait_for_devices(0.3, devices.data(), devices.size(), &count) == INKWELL_TIMED_OUT);
  CHECK(count == all);
  const std::string address = board->address;
  std::thread unplug([&] {
    board.reset();
    setenv("INKWELL_DEVICE", address.c_str(), 1);
  });
  CHECK(inkwell_wait_for_devices(60, devices.data(), devices.size(), &count) == INKWELL_OK);
  unplug.join();
  unsetenv("INKWELL_DEVICE");
  CHECK(count == all - 1);
  CHECK(inkwell_wait_for_devices(NAN, devices.data(), devices.size(), &count) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_wait_for_devices(0, nullptr, 8, &count) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("opening stops after its time-out if the board sends no poses") {
  Board board;
  board.control.pause();
  inkwell_arm* arm = nullptr;
  CHECK(inkwell_open_with_timeout(board.address.c_str(), 0.2, &arm) != INKWELL_OK);
  CHECK(arm == nullptr);
  CHECK(inkwell_open_with_timeout(board.address.c_str(), NAN, &arm) == INKWELL_BAD_ARGUMENT);
  board.control.resume();
  REQUIRE_MESSAGE(inkwell_open_with_timeout(board.address.c_str(), 60, &arm) == INKWELL_OK,
                  std::string(inkwell_error_text()));
  CHECK(inkwell_close(arm) == INKWELL_OK);
}

/// Names two running boards in a new file.
struct NamedBoards {
  TemporaryDirectory directory;
  Board left{{.seed = 1}}, right{{.seed = 2}};
  std::string file = directory.file("arms.toml");
  Environment names{"INKWELL_ARMS", file};

  NamedBoards() {
    unsetenv("INKWELL_DEVICE");
    std::ofstream(file) << "[[arm]]\nname = \"right\"\naddress = \"" << right.address << "\"\ncontrol = \""
                        << right.board.control_socket().text() << "\"\n[[arm]]\nname = \"left\"\naddress = \""
                        << left.address << "\"\n";
  }
};

std::string serial_number_of(inkwell_arm* arm) {
  inkwell_information information{};
  REQUIRE(inkwell_get_information(arm, &information) == INKWELL_OK);
  return information.serial_number;
}

TEST_CASE("a name opens its arm, and named arms are listed in the order of their names") {
  NamedBoards boards;
  inkwell_named_arm names[3];
  std::size_t count = 0;
  REQUIRE(inkwell_list_names(names, 3, &count) == INKWELL_OK);
  CHECK(count == 2);
  CHECK(std::string(names[0].name) == "right");
  CHECK(names[1].address == boards.left.address);
  std::vector<inkwell_device> devices(8);
  const auto number_of = [&](const std::string& address) {
    REQUIRE(inkwell_list_devices(devices.data(), devices.size(), &count) == INKWELL_OK);
    for (std::size_t i = 0; i < count; ++i)
      if (address == devices[i].address) return static_cast<int>(i);
    return -1;
  };
  CHECK(number_of(boards.right.address) == 0);
  CHECK(number_of(boards.left.address) == 1);
  const std::size_t all = count;
  {
    const Environment configured("INKWELL_DEVICE", "left");  // adds no second entry
    number_of(boards.left.address);
    CHECK(count == all);
    const VirtualArm arm(""), by_name("LEFT"), other("right");
    CHECK(serial_number_of(arm.arm) == serial_number_of(by_name.arm));
    CHECK(serial_number_of(arm.arm) != serial_number_of(other.arm));
    // The file names the control socket of the right board only.
    CHECK(inkwell_move_virtual_hand(other.arm, free_point_m, hand_N_per_m) == INKWELL_OK);
    CHECK(inkwell_move_virtual_hand(arm.arm, free_point_m, hand_N_per_m) == INKWELL_REFUSED);
  }
  CHECK(inkwell_list_names(nullptr, 2, &count) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("an unknown name and a damaged file of names are reported, and arms on USB are still listed") {
  const TemporaryDirectory directory;
  const Environment names("INKWELL_ARMS", directory.file("arms.toml"));
  std::ofstream(directory / "arms.toml") << "[[arm]]\nname = \"left\"\naddress = \"2A\"\n";
  inkwell_arm* arm = nullptr;
  CHECK(inkwell_open("lefft", &arm) == INKWELL_BAD_ARGUMENT);
  CHECK_MESSAGE(says("Did you mean left? Known names: left."), std::string(inkwell_error_text()));
  CHECK(inkwell_open("Left", &arm) == INKWELL_NO_DEVICE);
  CHECK_MESSAGE(says("The arm left is not plugged in."), std::string(inkwell_error_text()));
  std::ofstream(directory / "arms.toml", std::ios::app) << "[[arm]]\nname = \"Left\"\naddress = \"2B\"\n";
  CHECK(inkwell_open("left", &arm) == INKWELL_FAILED);
  CHECK_MESSAGE(says("line 4: The name `Left` is bound twice."), std::string(inkwell_error_text()));
  std::size_t count = 99;
  CHECK(inkwell_list_names(nullptr, 0, &count) == INKWELL_FAILED);
  CHECK(inkwell_list_devices(nullptr, 0, &count) == INKWELL_OK);
}

/// A port that accepts no connection, like that of a computer that is switched off.
struct SilentPort {
  local::Descriptor listener{socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::vector<local::Descriptor> waiting;
  sockaddr_in address{};

  SilentPort() {
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(listener.number(), reinterpret_cast<sockaddr*>(&address), size) == 0);
    REQUIRE(getsockname(listener.number(), reinterpret_cast<sockaddr*>(&address), &size) == 0);
    REQUIRE(listen(listener.number(), 0) == 0);
    for (int i = 0; i < 8; ++i) {  // the queue of connections is full after the first of them
      waiting.emplace_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      connect(waiting.back().number(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    }
  }
};

TEST_CASE("a computer that does not answer delays opening only for seconds") {
  const SilentPort silent;
  inkwell_arm* arm = nullptr;
  const std::string address = "usbip:127.0.0.1:" + std::to_string(ntohs(silent.address.sin_port));
  CHECK(inkwell_open_with_timeout(address.c_str(), 60, &arm) == INKWELL_FAILED);  // else TIMED_OUT after 60 s
  CHECK_MESSAGE(says("No program answers"), std::string(inkwell_error_text()));
}

}  // namespace
}  // namespace inkwell::tests
