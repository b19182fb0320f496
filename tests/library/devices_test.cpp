// Tests the list of arms, its changes, and the time limit of opening.
#include <doctest/doctest.h>

#include <arpa/inet.h>
#include <sys/socket.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <thread>
#include <vector>

#include <inkwell/inkwell.h>
#include "host/client/local/descriptor.hpp"
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

struct Environment {
  explicit Environment(const char* address) { setenv("INKWELL_DEVICE", address, 1); }
  ~Environment() { unsetenv("INKWELL_DEVICE"); }
};

std::size_t arms_on_usb() {
  std::size_t count = 99;
  REQUIRE(inkwell_list_devices(nullptr, 0, &count) == INKWELL_OK);
  return count;
}

TEST_CASE("a stale or misspelled INKWELL_DEVICE does not hide the arms on USB") {
  const std::size_t on_usb = arms_on_usb();
  for (const char* const address : {"usbip:127.0.0.1:1", "usbip:nowhere", "virtual?nonsense=1", "no such number"}) {
    CAPTURE(address);
    const Environment environment(address);
    std::size_t count = 99;
    CHECK_MESSAGE(inkwell_list_devices(nullptr, 0, &count) == INKWELL_OK, std::string(inkwell_error_text()));
    CHECK(count == on_usb);
  }
  const Environment environment("virtual");
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
