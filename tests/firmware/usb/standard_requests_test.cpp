// Standard requests of USB 2.0, chapter 9.
#include <doctest/doctest.h>

#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using test::answer;
using test::bytes_of;
using test::command;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::request;
using test::stall_result;

TEST_CASE("addresses up to 127 are taken, others refused") {
  DeviceBench bench;
  CHECK(bench.control(request(0x00, 5, 42, 0, 0)) == done_result);
  CHECK(bench.port.address() == 42);
  for (const std::uint16_t address : {128, 255, 256, 0xFFFF})
    CHECK(bench.control(request(0x00, 5, address, 0, 0)) == stall_result);
  CHECK(bench.control(request(0x00, 5, 43, 1, 0)) == stall_result);
  CHECK(bench.port.address() == 42);
  CHECK(bench.control(request(0x00, 5, 127, 0, 0)) == done_result);
  CHECK(bench.port.address() == 127);
}

TEST_CASE("a configuration is set, repeated, refused and taken back") {
  DeviceBench bench;
  const auto current = [&] { return bench.control(request(0x80, 8, 0, 0, 1)); };
  CHECK(current() == answer({0}));
  CHECK_FALSE(bench.port.is_open(0x81));
  for (int round = 0; round < 3; ++round) {
    CHECK(bench.configure(1) == done_result);
    CHECK(current() == answer({1}));
    CHECK(bench.device.configured());
    for (const int endpoint : {0x81, 0x01, 0x82}) CHECK(bench.port.is_open(static_cast<std::uint8_t>(endpoint)));
  }
  for (const std::uint16_t value : {2, 255, 0x0101, 0xFFFF}) {
    CHECK(bench.configure(value) == stall_result);
    CHECK(current() == answer({1}));
  }
  CHECK(bench.configure(0) == done_result);
  CHECK(current() == answer({0}));
  CHECK_FALSE(bench.port.is_open(0x82));
  bench.run(100);
  bench.device.poll();
  CHECK(bench.port.in(1).handshake == Handshake::nak);
}

TEST_CASE("a repeated configuration starts toggles and transfers again") {
  DeviceBench bench;
  bench.configure();
  bench.run(20);
  bench.device.poll();
  CHECK(bench.port.in(1).handshake == Handshake::ack);
  CHECK(bench.port.data_toggle(0x81));
  bench.run(20);
  bench.device.poll();  // a transfer is in progress
  CHECK(bench.configure() == done_result);
  CHECK_FALSE(bench.port.data_toggle(0x81));
  bench.run(20);
  bench.device.poll();
  CHECK(bench.port.in(1).data.size() == 64);
}

TEST_CASE("status of device, interfaces and endpoints") {
  DeviceBench bench;
  CHECK(bench.control(request(0x80, 0, 0, 0, 2)) == answer({1, 0}));  // self-powered
  CHECK(bench.control(request(0x81, 0, 0, 0, 2)) == stall_result);    // not configured
  CHECK(bench.control(request(0x82, 0, 0, 0x81, 2)) == stall_result);
  CHECK(bench.control(request(0x82, 0, 0, 0x00, 2)) == answer({0, 0}));
  bench.configure();
  CHECK(bench.control(request(0x81, 0, 0, 0, 2)) == answer({0, 0}));
  CHECK(bench.control(request(0x81, 0, 0, 1, 2)) == answer({0, 0}));
  for (const int endpoint : {0x00, 0x80, 0x81, 0x01, 0x82, 0x83})
    CHECK(bench.control(request(0x82, 0, 0, static_cast<std::uint16_t>(endpoint), 2)) == answer({0, 0}));
  CHECK(bench.control(request(0x80, 0, 1, 0, 2)) == stall_result);
  CHECK(bench.control(request(0x81, 0, 0, 2, 2)) == answer({0, 0}));
  CHECK(bench.control(request(0x81, 0, 0, 3, 2)) == answer({0, 0}));
  CHECK(bench.control(request(0x81, 0, 0, 4, 2)) == stall_result);
  for (const int endpoint : {0x02, 0x84, 0x03, 0x8F, 0x0181, 0xFF81})
    CHECK(bench.control(request(0x82, 0, 0, static_cast<std::uint16_t>(endpoint), 2)) == stall_result);
  CHECK(bench.control(request(0x83, 0, 0, 0, 2)) == stall_result);
}

TEST_CASE("an endpoint can be halted and released, and restarts with data toggle 0") {
  DeviceBench bench;
  bench.configure();
  for (const int address : {0x81, 0x01, 0x82, 0x83}) {
    const auto endpoint = static_cast<std::uint8_t>(address);
    CHECK(bench.control(request(0x02, 3, 0, endpoint, 0)) == done_result);
    CHECK(bench.port.is_stalled(endpoint));
    CHECK(bench.control(request(0x82, 0, 0, endpoint, 2)) == answer({1, 0}));
    bench.run(40);
    bench.device.poll();  // the port fails the test if the device sends on a halted endpoint
    CHECK(bench.control(request(0x02, 1, 0, endpoint, 0)) == done_result);
    CHECK_FALSE(bench.port.is_stalled(endpoint));
    CHECK_FALSE(bench.port.data_toggle(endpoint));
    CHECK(bench.control(request(0x82, 0, 0, endpoint, 2)) == answer({0, 0}));
  }
  bench.run(20);
  bench.device.poll();
  CHECK(bench.port.in(1).handshake == Handshake::ack);
  CHECK(bench.port.out(1, bytes_of(command(protocol::Command::heartbeat, 1))) == Handshake::ack);

  CHECK(bench.control(request(0x02, 3, 0, 0x84, 0)) == stall_result);
  CHECK(bench.control(request(0x02, 3, 1, 0x81, 0)) == stall_result);
  CHECK(bench.control(request(0x00, 3, 1, 0, 0)) == stall_result);       // remote wake-up
  CHECK(bench.control(request(0x00, 3, 2, 0x0100, 0)) == stall_result);  // test modes exist only at high speed
}

TEST_CASE("the one setting of each interface is taken, others are refused") {
  DeviceBench bench;
  CHECK(bench.control(request(0x01, 11, 0, 0, 0)) == stall_result);
  bench.configure();
  for (const std::uint16_t index : {0, 1, 2, 3}) {
    CHECK(bench.control(request(0x01, 11, 0, index, 0)) == done_result);
    CHECK(bench.control(request(0x81, 10, 0, index, 1)) == answer({0}));
    CHECK(bench.control(request(0x01, 11, 1, index, 0)) == stall_result);
  }
  CHECK(bench.control(request(0x01, 11, 0, 4, 0)) == stall_result);
  CHECK(bench.control(request(0x81, 10, 0, 4, 1)) == stall_result);
}

TEST_CASE("the setting of an interface starts its endpoints again and no others") {
  DeviceBench bench;
  bench.configure();
  bench.run(20);
  bench.device.poll();
  CHECK(bench.port.in(1).handshake == Handshake::ack);
  CHECK(bench.port.in(3).handshake == Handshake::ack);
  CHECK(bench.control(request(0x01, 11, 0, 2, 0)) == done_result);
  CHECK_FALSE(bench.port.data_toggle(0x83));
  CHECK(bench.port.data_toggle(0x81));
  CHECK(bench.control(request(0x01, 11, 0, 0, 0)) == done_result);
  CHECK_FALSE(bench.port.data_toggle(0x81));
}

TEST_CASE("unknown requests of every type are refused") {
  DeviceBench bench;
  bench.configure();
  for (unsigned type = 0; type < 256; ++type)
    for (const unsigned number : {2u, 4u, 7u, 12u, 13u, 100u, 255u}) {
      if ((type & 0x60) == 0x20 && number == 2) continue;  // GET_IDLE
      const std::uint16_t length = type & 0x80 ? 8 : 0;
      CHECK(bench.control(request(static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(number), 0, 0, length)) ==
            stall_result);
    }
  CHECK(bench.control(request(0x80, 8, 0, 0, 1)) == answer({1}));
}

}  // namespace inkwell
