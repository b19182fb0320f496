// Tests device addresses from users, and the arms that these addresses select.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <span>

#include "host/client/device/address.hpp"
#include "host/client/device/device.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/host/client/device/fake_usb.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using device::Address;
using device::parse_address;

namespace {

std::string refusal(const Address& address) {
  return message_of<device::NoDevice>([&] { device::find_arm(address); });
}

}  // namespace

TEST_CASE("an address is a serial number, a USB/IP server or a virtual board") {
  CHECK(parse_address("").kind == Address::Kind::usb);
  CHECK(parse_address("").serial_number.empty());
  CHECK(parse_address("3932").serial_number == "3932");
  CHECK(parse_address("virtually").kind == Address::Kind::usb);
  const auto server = parse_address("usbip:host.example:3240");
  CHECK(server.kind == Address::Kind::usbip);
  CHECK(server.server.host == "host.example");
  CHECK(server.server.port == 3240);
  for (const auto here : {"3240", ":3240", "127.0.0.1:3240"}) {
    CHECK(device::parse_server(here).server.host == "127.0.0.1");
    CHECK(device::parse_server(here).server.port == 3240);
  }
  for (const auto& at_socket : {parse_address("usbip:unix:/run/board"), device::parse_server("unix:/run/board")}) {
    CHECK(at_socket.kind == Address::Kind::usbip);
    CHECK(at_socket.server.path == "/run/board");
    CHECK(at_socket.server.text() == "unix:/run/board");
  }
  CHECK(parse_address("virtual").kind == Address::Kind::own_board);
  CHECK(parse_address("virtual").arm.empty());
  CHECK(parse_address("virtual:arms/mine.toml").kind == Address::Kind::own_board);
  CHECK(parse_address("virtual:arms/mine.toml").arm == "arms/mine.toml");
}

TEST_CASE("the address that `inkwell run` prints is accepted as the address of a server") {
  for (const auto text : {"127.0.0.1:3240", "usbip:127.0.0.1:3240", "usbip:3240"})
    CHECK(device::parse_server(text).server.text() == "127.0.0.1:3240");
  CHECK(device::parse_server("usbip:unix:/run/board").server.path == "/run/board");
}

TEST_CASE("an IPv6 address is in brackets") {
  for (const auto& address : {parse_address("usbip:[::1]:3240"), device::parse_server("[::1]:3240")}) {
    CHECK(address.server.host == "::1");
    CHECK(address.server.port == 3240);
    CHECK(address.server.text() == "[::1]:3240");
  }
  for (const auto wrong : {"::1:3240", "[::1]", "[::1]3240", "[]:3240", "[::1:3240", "::1]:3240"}) {
    CAPTURE(wrong);
    const auto message = message_of<device::BadAddress>([&] { device::parse_server(wrong); });
    CHECK(contains(message, "[::1]:3240"));
  }
}

TEST_CASE("a virtual board has options") {
  const auto board = parse_address("virtual?seed=18446744073709551615&arm=arms/my arm.toml&elf=a=b.elf");
  CHECK(board.kind == Address::Kind::own_board);
  CHECK(board.seed == 18446744073709551615u);
  CHECK(board.arm == "arms/my arm.toml");
  CHECK(board.elf == "a=b.elf");
  CHECK(parse_address("virtual?").kind == Address::Kind::own_board);
  CHECK_FALSE(parse_address("virtual?arm=x").seed);
  CHECK(parse_address("virtual:what?seed=7").arm == "what?seed=7");
  for (const auto wrong : {"speed=7", "seed", "seed=", "seed=-1", "seed=7x", "arm=", "seed=7,arm=x", "&seed=7"}) {
    CAPTURE(wrong);
    const auto message = message_of<device::BadAddress>([&] { parse_address(std::string("virtual?") + wrong); });
    CHECK(contains(message, "virtual?seed=7"));
  }
}

TEST_CASE("the error for an invalid address contains a valid address") {
  for (const auto wrong :
       {"usbip:", "usbip:nowhere", "usbip:host:", "usbip:host:0", "usbip:host:65536", "usbip:host:3x"}) {
    CAPTURE(wrong);
    CHECK(contains(message_of<device::BadAddress>([&] { parse_address(wrong); }), "127.0.0.1:3240"));
  }
}

TEST_CASE("the error for an unusable socket path states the reason") {
  for (const auto& wrong :
       {std::string("usbip:unix:"), std::string("usbip:unix:/a b"), "usbip:unix:/" + std::string(200, 'x')}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(parse_address(wrong), device::BadAddress);
  }
  const std::string nobody =
      message_of<device::Error>([] { device::find_arm(parse_address("usbip:unix:/nowhere/x")); });
  CHECK(contains(nobody, "No program answers at unix:/nowhere/x"));
}

TEST_CASE("a misspelled address is not taken for a serial number") {
  FakeUsb usb;
  const auto message = [](const char* text) {
    return message_of<device::BadAddress>([&] { device::find_arm(parse_address(text)); });
  };
  CHECK(contains(message("virtul"),
                 "`virtul` is neither a serial number, a name nor another address. Did you mean virtual?"));
  CHECK(contains(message("usbp:127.0.0.1:3240"), "usbip:HOST:PORT"));
  CHECK(contains(message("127.0.0.1:3240"), "usbip:HOST:PORT"));
  usb.add_arm("my arm");
  CHECK(device::find_arm(parse_address("my arm")).serial_number == "my arm");
}

TEST_CASE("find_arm returns the requested arm, or raises an error that lists the arms") {
  FakeUsb usb;
  CHECK(contains(refusal({}), "No arm was found on USB"));
  CHECK(contains(refusal(parse_address("0033")), "0033 is plugged in. Plug it in"));
  usb.add_arm("0011");
  CHECK(device::find_arm({}).serial_number == "0011");
  CHECK(device::address_of(device::find_arm({})) == "0011");
  usb.add_arm("0022");
  CHECK(contains(refusal({}), "2 arms are plugged in. Choose one by its serial number:"));
  for (const auto number : {" 0011", " 0022"}) {
    CHECK(contains(refusal({}), number));
    CHECK(contains(refusal(parse_address("0033")), number));
  }
  CHECK(device::find_arm(parse_address("0022")).serial_number == "0022");
  CHECK(contains(refusal(parse_address("0033")),
                 "No arm with the serial number 0033 is plugged in. The connected arms are:"));
  CHECK(device::find_arms(parse_address("virtual")).empty());
}

TEST_CASE("an arm at a server is found by its address, and its endpoint has the same address") {
  FakeUsbipServer server;
  const auto address = device::address_of(server.endpoint());
  const auto found = device::find_arm(parse_address(address));
  CHECK(found.server.port == server.port());
  CHECK(device::address_of(found) == address);
  server.product_id = 0x0BAD;
  CHECK(contains(refusal(parse_address(address)), "exports no arm"));
}

TEST_CASE("an arm at a Unix socket is found by its address, and its endpoint has the same address") {
  const TemporaryDirectory directory;
  FakeUsbipServer server(device::SocketAddress{.path = directory / "usbip"});
  const auto address = device::address_of(server.endpoint());
  CHECK(address == "usbip:unix:" + directory.file("usbip"));
  const auto found = device::find_arm(parse_address(address));
  CHECK(device::address_of(found) == address);
  CHECK(device::Device::open(found)->information().serial_number == "0123456789ABCDEF01234567");
}

TEST_CASE("the arm of a board that is just starting is waited for, since the server answers before it shows itself") {
  FakeUsbipServer server;
  int lists = 0;
  constexpr std::size_t list_of_none = 12;  // header and count
  server.spoil_reply = [&](Bytes& reply) {
    if (++lists > 3) return;
    reply.resize(list_of_none);
    std::ranges::fill(std::span(reply).last(4), std::byte{0});
  };
  CHECK(device::find_arm(parse_address(device::address_of(server.endpoint()))).server.port == server.port());
  CHECK(lists == 4);
}

TEST_CASE("looking for arms leaves no connection open, whether anybody answers or not") {
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  FakeUsbipServer server;
  const auto open_before = open_files();
  CHECK(device::find_usbip_devices({"127.0.0.1", server.port()}).size() == 1);
  CHECK_THROWS_AS(device::find_usbip_devices({"127.0.0.1", 1}), device::Error);
  CHECK(eventually([&] { return open_files() == open_before; }));
}
