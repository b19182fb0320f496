// The device as programs of this computer see it: USB/IP over a loopback socket.
#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>

#include "usbip_client.hpp"

namespace inkwell::virtual_usb_test {
namespace {

constexpr std::uint32_t submitted = 3, unlinked = 4;
constexpr std::array<std::uint8_t, 8> get_device_descriptor{0x80, 6, 0, 1, 0, 0, 18, 0};
constexpr std::array<std::uint8_t, 8> set_configuration{0x00, 9, 5, 0, 0, 0, 0, 0};
constexpr std::array<std::uint8_t, 8> set_address{0x00, 5, 77, 0, 0, 0, 0, 0};
constexpr std::array<std::uint8_t, 8> unknown_request{0xC0, 99, 0, 0, 0, 0, 8, 0};
constexpr std::array<std::uint8_t, 8> store_100_bytes{0x40, 2, 0, 0, 0, 0, 100, 0};

void configure(UsbIpClient& client, std::uint32_t sequence = 1) {
  client.submit(sequence, 0, false, 0, {}, set_configuration);
  const Reply reply = client.read_reply();
  REQUIRE(reply.command == submitted);
  REQUIRE(reply.sequence == sequence);
  REQUIRE(reply.status == 0);
}

TEST_CASE("the device list shows descriptors once the device is enumerated") {
  LiveBoard board;
  board.call([&] { board.usb.disconnect(); });
  {
    UsbIpClient client(board.usb.port());
    client.send_operation(0x8005);
    const Bytes empty = client.receive(12);
    REQUIRE(empty.size() == 12);
    CHECK(read_32(empty, 8) == 0);
  }
  board.call([&] { board.usb.connect(); });
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  client.send_operation(0x8005);
  const Bytes list = client.receive(12 + 312 + 2 * 4);
  REQUIRE(list.size() == 12 + 312 + 2 * 4);
  CHECK(read_32(list, 0) == 0x0111'0005);
  CHECK(read_32(list, 4) == 0);
  CHECK(read_32(list, 8) == 1);
  CHECK(std::string(reinterpret_cast<const char*>(list.data() + 12 + 256)) == "1-1");
  constexpr std::size_t device = 12 + 256 + 32;
  CHECK(read_32(list, device) == 1);
  CHECK(read_32(list, device + 4) == 2);
  CHECK(read_32(list, device + 8) == 2);  // full speed
  CHECK(read_16(list, device + 12) == 0x1209);
  CHECK(read_16(list, device + 14) == 0x0001);
  CHECK(read_16(list, device + 16) == 0x0134);
  CHECK(std::to_integer<int>(list[device + 22]) == 1);  // configurations
  CHECK(std::to_integer<int>(list[device + 23]) == 2);  // interfaces
  CHECK(std::to_integer<int>(list[device + 24]) == 3);  // HID
  CHECK(std::to_integer<int>(list[device + 28]) == 0xFF);
}

TEST_CASE("control transfers and errors over the socket") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == 0);
  client.submit(7, 0, true, 18, {}, get_device_descriptor);
  Reply reply = client.read_reply();
  CHECK(reply.command == submitted);
  CHECK(reply.sequence == 7);
  CHECK(reply.status == 0);
  REQUIRE(reply.actual_length == 18);
  const Bytes descriptor = client.receive(18);
  CHECK(descriptor[0] == std::byte{18});
  CHECK(descriptor[8] == std::byte{0x09});

  client.submit(8, 0, true, 8, {}, unknown_request);
  reply = client.read_reply();
  CHECK(reply.sequence == 8);
  CHECK(reply.status == -32);
  CHECK(reply.actual_length == 0);

  Bytes data(100);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = pattern(i);
  client.submit(9, 0, false, 100, data, store_100_bytes);
  reply = client.read_reply();
  CHECK(reply.status == 0);
  CHECK(reply.actual_length == 100);
  board.call([&] { CHECK(board.firmware.control_received == data); });

  client.submit(10, 0, false, 0, {}, set_address);  // answered, but the device keeps the port's address
  CHECK(client.read_reply().status == 0);
  board.call([&] { CHECK(board.firmware.address == 2); });

  client.submit(11, 2, true, 64);
  CHECK(client.read_reply().status == -22);
  board.call([&] { CHECK(board.log.sentences.empty()); });
}

TEST_CASE("a second importer is refused, an unknown device too, and a next one is welcome") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  {
    UsbIpClient first(board.usb.port());
    REQUIRE(first.import() == 0);
    UsbIpClient second(board.usb.port());
    CHECK(second.import() == 2);
    CHECK(second.closed());
    UsbIpClient third(board.usb.port());
    CHECK(third.import("2-1") == 4);
    CHECK(third.closed());
    configure(first);
  }
  REQUIRE(board.wait_until_enumerated());  // until the release has arrived
  unsigned resets = 0;
  board.call([&] { resets = board.firmware.resets; });
  for (int i = 0; i < 3; ++i) {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient next(board.usb.port());
    REQUIRE(next.import() == 0);
    configure(next);
  }
  board.call([&] { CHECK(board.firmware.resets == resets + 3); });
}

TEST_CASE("64 bulk transfers deep, nothing lost") {
  LiveBoard board;
  board.firmware.stream(true);
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == 0);
  configure(client);
  constexpr std::uint32_t length = 1024;
  std::uint32_t submitted_count = 0;
  for (; submitted_count < 64; ++submitted_count) client.submit(100 + submitted_count, 2, true, length);
  std::uint32_t expected = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Reply reply = client.read_reply();
    REQUIRE(reply.sequence == 100 + i);
    REQUIRE(reply.actual_length == length);
    const Bytes data = client.receive(length);
    for (std::size_t at = 0; at < length; at += 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, data.data() + at, 4);
      REQUIRE(word == expected++);
    }
    client.submit(100 + submitted_count++, 2, true, length);
  }
}

TEST_CASE("an unlinked transfer is answered once, by the unlink") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == 0);
  configure(client);
  client.submit(20, 1, true, 64);
  client.submit(21, 1, true, 64);
  client.unlink(22, 20);
  Reply reply = client.read_reply();
  CHECK(reply.command == unlinked);
  CHECK(reply.sequence == 22);
  CHECK(reply.status == -104);
  const Bytes report(10, std::byte{42});
  board.call([&] { board.firmware.send_report(report); });
  reply = client.read_reply();
  CHECK(reply.command == submitted);
  CHECK(reply.sequence == 21);
  CHECK(client.receive(reply.actual_length) == report);
  client.unlink(23, 21);  // too late: it was answered
  reply = client.read_reply();
  CHECK(reply.command == unlinked);
  CHECK(reply.sequence == 23);
  CHECK(reply.status == 0);
  client.submit(20, 0, true, 18, {}, get_device_descriptor);  // its number is free again
  CHECK(client.read_reply().sequence == 20);
}

TEST_CASE("unplug closes the importer's connection; after replug it can import again") {
  LiveBoard board;
  board.firmware.stream(true);
  REQUIRE(board.wait_until_enumerated());
  {
    UsbIpClient client(board.usb.port());
    REQUIRE(client.import() == 0);
    configure(client);
    client.submit(30, 1, true, 64);
    board.call([&] { board.usb.disconnect(); });
    CHECK(client.closed());
    UsbIpClient other(board.usb.port());
    CHECK(other.import() == 4);
  }
  board.call([&] { board.usb.connect(); });
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == 0);
  configure(client);
  client.submit(31, 2, true, 64);
  CHECK(client.read_reply().actual_length == 64);
}

TEST_CASE("while the simulation is paused, lists and imports are answered and transfers wait") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  board.pause(true);
  UsbIpClient client(board.usb.port());
  client.send_operation(0x8005);
  CHECK(client.receive(12 + 312 + 8).size() == 12 + 312 + 8);
  REQUIRE(client.import() == 0);
  client.submit(40, 0, true, 18, {}, get_device_descriptor);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  board.call([&] { CHECK(board.firmware.resets == 2); });
  board.pause(false);
  CHECK(client.read_reply().sequence == 40);
}

TEST_CASE("nonsense closes the connection, not the server") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  const std::uint16_t port = board.usb.port();
  {
    UsbIpClient client(port);
    client.send_operation(0x8005, 0x0100);
    CHECK(client.closed());
  }
  {
    UsbIpClient client(port);
    client.send_operation(0x8888);
    CHECK(client.closed());
  }
  constexpr std::uint32_t device = 0x0001'0002;
  const std::array<std::array<std::uint32_t, 10>, 8> headers{{
      {9, 1, device, 1, 0, 0, 18, 0, 0, 0},           // unknown command
      {1, 1, 0x0001'0003, 1, 0, 0, 18, 0, 0, 0},      // another device
      {1, 1, device, 2, 0, 0, 18, 0, 0, 0},           // neither IN nor OUT
      {1, 1, device, 1, 16, 0, 18, 0, 0, 0},          // no such endpoint number
      {1, 1, device, 1, 2, 0, 0xFFFF'FFF0, 0, 0, 0},  // endless
      {1, 1, device, 0, 2, 0, 0x7FFF'FFFF, 0, 0, 0},  // endless
      {1, 1, device, 1, 2, 0, 64, 0, 4, 0},           // isochronous
      {1, 1, device, 0, 0, 0, 18, 0, 0, 0},           // OUT, but the request says IN
  }};
  for (const auto& header : headers) {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient client(port);
    REQUIRE(client.import() == 0);
    client.send_header(header, get_device_descriptor);
    CHECK(client.closed());
  }
  {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient client(port);
    REQUIRE(client.import() == 0);
    configure(client);
    client.submit(50, 1, true, 64);
    client.submit(50, 1, true, 64);  // the same number twice
    CHECK(client.closed());
  }
  {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient client(port);
    REQUIRE(client.import() == 0);
    client.send(Bytes(20));  // half a command, then gone
  }
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(port);
  REQUIRE(client.import() == 0);
  configure(client);
}

TEST_CASE("a busy port is reported in a sentence") {
  LiveBoard board;
  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  std::string message;
  try {
    virtual_board::VirtualUsb second({scheduler, interrupts, log, log, state}, board.usb.port(), [] {});
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  CHECK(message.find(std::to_string(board.usb.port())) != std::string::npos);
  CHECK(message.find("another program listens") != std::string::npos);
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
