#include <doctest/doctest.h>

#include "boards/stm32f405/debugger/gdb_packets.hpp"

using namespace inkwell::virtual_board;
using Kind = GdbPackets::Received::Kind;

TEST_SUITE("virtual board: debugger") {
  TEST_CASE("packets are found however the bytes arrive") {
    const std::string wire = "+$g#67-\x03$m20000000,4#4f";
    for (std::size_t step = 1; step <= wire.size(); ++step) {
      GdbPackets packets;
      std::vector<GdbPackets::Received> received;
      for (std::size_t at = 0; at < wire.size(); at += step) {
        packets.feed(std::string_view(wire).substr(at, step));
        while (auto next = packets.take()) received.push_back(*next);
      }
      CAPTURE(step);
      REQUIRE(received.size() == 3);
      CHECK(received[0].kind == Kind::packet);
      CHECK(received[0].payload == "g");
      CHECK(received[1].kind == Kind::interrupt);
      CHECK(received[2].payload == "m20000000,4");
    }
  }

  TEST_CASE("a packet with a wrong checksum is damaged, and the next one is whole") {
    GdbPackets packets;
    packets.feed("$g#68$g#zz$g#67");
    CHECK(packets.take()->kind == Kind::damaged);
    CHECK(packets.take()->kind == Kind::damaged);
    CHECK(packets.take()->kind == Kind::packet);
    CHECK_FALSE(packets.take());
  }

  TEST_CASE("packet control characters in a payload are escaped when sent and restored when received") {
    const std::string payload = "a#b$c}d*e";
    GdbPackets packets;
    packets.feed(gdb_packet(payload));
    const auto received = packets.take();
    REQUIRE(received);
    CHECK(received->kind == Kind::packet);
    CHECK(received->payload == payload);
    CHECK(gdb_packet("OK") == "$OK#9a");
  }

  TEST_CASE("hexadecimal digits") {
    CHECK(hexadecimal(std::string_view("Az\x01")) == "417a01");
    CHECK(bytes_of("417a01") == std::vector<std::uint8_t>{0x41, 0x7A, 0x01});
    CHECK(bytes_of("")->empty());
    CHECK_FALSE(bytes_of("417"));
    CHECK_FALSE(bytes_of("4g"));
    CHECK(number_of("ffffffff") == 0xFFFF'FFFF);
    CHECK_FALSE(number_of("100000000"));
    CHECK_FALSE(number_of(""));
    CHECK_FALSE(number_of("12 "));
  }
}
