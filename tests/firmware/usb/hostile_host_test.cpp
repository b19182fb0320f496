// Tests hosts that abort transfers, use wrong lengths, or disappear.
#include <doctest/doctest.h>

#include "tests/firmware/link/transaction.hpp"
#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using test::Bytes;
using test::bytes_of;
using test::command;
using test::ControlResult;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::InPacket;
using test::request;
using test::stall_result;

namespace {

void check_alive(DeviceBench& bench) { CHECK(bench.get_descriptor(0x0100, 18).data.size() == 18); }

/// A SET_REPORT of all parameters: 13 packets.
constexpr usb::SetupPacket set_parameters = {0x21, 9, 0x0311, 0, sizeof(protocol::ParametersReport)};

std::uint32_t transactions(DeviceBench& bench) {
  return bench.get_feature<protocol::TransactionReport>(protocol::ReportId::transaction).transactions;
}

}  // namespace

TEST_CASE("a control read returns exactly wLength bytes, or the whole report if it is shorter") {
  DeviceBench bench;
  bench.configure();
  struct {
    std::uint8_t type, number;
    std::uint16_t value, index;
  } const reads[] = {{0x80, 6, 0x0100, 0}, {0x80, 6, 0x0200, 0}, {0x80, 6, 0x0303, 0}, {0x81, 6, 0x2200, 0},
                     {0xC0, 0x20, 0, 7},   {0xA1, 1, 0x0310, 0}, {0xA1, 1, 0x0311, 0}};
  for (const auto& read : reads) {
    const Bytes all = bench.control(request(read.type, read.number, read.value, read.index, 65535)).data;
    REQUIRE(!all.empty());
    const auto exact = static_cast<unsigned>(all.size());
    for (const unsigned length : {1u,   2u,   7u,   8u,   9u,   63u,   64u,       65u,   127u,      128u,  129u,
                                  192u, 256u, 512u, 576u, 640u, 4096u, exact - 1, exact, exact + 1, 65535u}) {
      if (length == 0) continue;
      CAPTURE(length);
      // DeviceBench::read() checks whether a short packet must end the answer.
      const auto w_length = static_cast<std::uint16_t>(length);
      const Bytes data = bench.control(request(read.type, read.number, read.value, read.index, w_length)).data;
      CHECK(data == Bytes(all.begin(), all.begin() + std::min(length, exact)));
    }
    CHECK(bench.control(request(read.type, read.number, read.value, read.index, 0)) == done_result);
  }
}

TEST_CASE("an answer with a multiple of 64 bytes ends with an empty packet only if the host requested more bytes") {
  DeviceBench bench;
  bench.configure();
  bench.run(20);
  // The pose has 64 bytes.
  bench.setup(request(0xA1, 1, 0x0101, 0, 64));
  CHECK(bench.port.in(0).data.size() == 64);
  bench.device.poll();
  CHECK(bench.port.in(0).handshake == Handshake::nak);
  CHECK(bench.port.out(0, {}) == Handshake::ack);
  bench.device.poll();

  bench.setup(request(0xA1, 1, 0x0101, 0, 65));
  CHECK(bench.port.in(0).data.size() == 64);
  bench.device.poll();
  const InPacket end = bench.port.in(0);
  CHECK(end.handshake == Handshake::ack);
  CHECK(end.data.empty());
  bench.device.poll();
  CHECK(bench.port.in(0).handshake == Handshake::nak);
  CHECK(bench.port.out(0, {}) == Handshake::ack);
}

TEST_CASE("a SETUP packet in any data or status stage starts a new control transfer") {
  DeviceBench bench;
  bench.configure();
  const usb::SetupPacket get_parameters = {0xA1, 1, 0x0311, 0, 4096};
  for (int packets = 0; packets < 12; ++packets) {  // aborts a read after this number of packets
    bench.setup(get_parameters);
    for (int i = 0; i < packets; ++i) {
      if (bench.port.in(0).handshake != Handshake::ack) break;
      bench.device.poll();
    }
    check_alive(bench);
  }
  const std::array<std::byte, 64> part{std::byte{0x11}};
  for (int packets = 0; packets < 13; ++packets) {  // aborts a write
    bench.setup(set_parameters);
    for (int i = 0; i < std::min(packets, 12); ++i) {
      CHECK(bench.port.out(0, part) == Handshake::ack);
      bench.device.poll();
    }
    check_alive(bench);
  }
  CHECK(transactions(bench) == 0);
  // The next SETUP arrives in the status stage of a write, before and after the host reads the status.
  bench.setup(request(0x00, 9, 1, 0, 0));
  check_alive(bench);
  bench.setup(request(0x00, 9, 1, 0, 0));
  bench.port.in(0);
  check_alive(bench);  // the next SETUP arrives before the device has processed the end of the status stage
  // The next SETUP arrives in the status stage of a read.
  bench.setup(request(0x80, 6, 0x0100, 0, 18));
  bench.port.in(0);
  check_alive(bench);
  bench.setup(request(0x80, 6, 0x0100, 0, 18));
  bench.port.in(0);
  bench.device.poll();
  check_alive(bench);
}

TEST_CASE("SETUPs back to back: only the last one is answered") {
  DeviceBench bench;
  const usb::SetupPacket packets[] = {{0x80, 6, 0x0200, 0, 255}, {0x00, 9, 1, 0, 0}, {0x80, 6, 0x0100, 0, 18}};
  for (const usb::SetupPacket& packet : packets) bench.port.setup(std::as_bytes(std::span(&packet, 1)));
  bench.device.poll();
  const ControlResult result = bench.read(18);
  CHECK(result.data.size() == 18);
  CHECK(result.data[1] == std::byte{1});
}

TEST_CASE("the device ends a control read when the host starts the status stage early") {
  DeviceBench bench;
  bench.configure();
  bench.setup(request(0xA1, 1, 0x0311, 0, 4096));
  CHECK(bench.port.in(0).data.size() == 64);
  bench.device.poll();
  CHECK(bench.port.out(0, {}) == Handshake::ack);
  bench.device.poll();
  CHECK(bench.port.in(0).handshake == Handshake::nak);
  check_alive(bench);
}

TEST_CASE("a write of no bytes, of too many for the buffer, or more or less than wLength is refused") {
  DeviceBench bench;
  bench.configure();
  CHECK(bench.control(request(0x21, 9, 0x0311, 0, 0)) == stall_result);
  for (const unsigned length : {protocol::force_law_report_maximum + 1, std::size_t{2112}, std::size_t{65535}}) {
    bench.setup(request(0x21, 9, 0x0311, 0, static_cast<std::uint16_t>(length)));
    const std::array<std::byte, 64> part{std::byte{0x11}};
    CHECK(bench.port.out(0, part) == Handshake::stall);
    CHECK(bench.port.in(0).handshake == Handshake::stall);
  }
  // Each case sends one packet whose length differs from wLength.
  const std::array<std::byte, 64> packet{std::byte{0x11}};
  const struct {
    std::uint16_t length;
    std::size_t sent;
  } wrong[] = {{16, 17}, {16, 64}, {16, 15}, {16, 0}, {12, 13}, {63, 64}, {65, 63}, {128, 8}, {776, 40}, {2048, 63}};
  for (const auto& [length, sent] : wrong) {
    bench.setup(request(0x21, 9, 0x0311, 0, length));
    CHECK(bench.port.out(0, std::span(packet).first(sent)) == Handshake::ack);
    bench.device.poll();
    CHECK(bench.port.in(0).handshake == Handshake::stall);
    CHECK(bench.port.out(0, packet) == Handshake::stall);
  }
  // The last packet is longer than the remaining data.
  bench.setup(request(0x21, 9, 0x0311, 0, 72));
  CHECK(bench.port.out(0, packet) == Handshake::ack);
  bench.device.poll();
  CHECK(bench.port.out(0, std::span(packet).first(9)) == Handshake::ack);
  bench.device.poll();
  CHECK(bench.port.in(0).handshake == Handshake::stall);
  CHECK(transactions(bench) == 0);
  check_alive(bench);
}

TEST_CASE("writes of 64, 65, 128 and the whole buffer arrive whole") {
  DeviceBench bench;
  bench.configure();
  std::uint32_t transactions = 0;
  for (const std::size_t size : {std::size_t{64}, std::size_t{65}, std::size_t{127}, std::size_t{128}, std::size_t{129},
                                 sizeof(protocol::ParametersReport)}) {
    CAPTURE(size);
    // The device refuses a report whose length does not match its number of entries.
    test::Transaction transaction{};
    auto& report = transaction.report();
    report.count = static_cast<std::uint16_t>((size - protocol::parameters_report_size(0)) / sizeof(*report.entries));
    for (std::size_t i = 0; i + 1u < report.count; ++i)
      report.entries[i] = {protocol::parameter_table[i % protocol::parameter_count].id, 0,
                           protocol::parameter_table[i % protocol::parameter_count].default_value};
    report.entries[report.count - 1] = {9999, 0, 0.0f};
    CHECK(bench.control(request(0x21, 9, 0x0311, 0, static_cast<std::uint16_t>(size)), transaction.bytes(size)) ==
          done_result);
    const auto result = bench.get_feature<protocol::TransactionReport>(protocol::ReportId::transaction);
    CHECK(result.transactions == ++transactions);
    const bool fits_table = report.count <= protocol::parameter_count + 1;
    CHECK(result.refusal == (fits_table ? protocol::Refusal::unknown_parameter : protocol::Refusal::given_twice));
  }
}

TEST_CASE("the device stalls a control request with an unexpected direction or length") {
  DeviceBench bench;
  bench.configure();
  bench.setup(request(0x00, 9, 1, 0, 4));  // SET_CONFIGURATION with data
  CHECK(bench.port.out(0, {}) == Handshake::stall);
  bench.setup(request(0x00, 5, 3, 0, 1));
  CHECK(bench.port.in(0).handshake == Handshake::stall);
  CHECK(bench.port.address() == 0);
  bench.setup(request(0x80, 9, 1, 0, 0));  // wrong direction
  CHECK(bench.port.in(0).handshake == Handshake::stall);
  check_alive(bench);
}

TEST_CASE("unexpected packets are answered with NAK") {
  DeviceBench bench;
  CHECK(bench.port.out(0, {}) == Handshake::nak);
  CHECK(bench.port.out(1, {}) == Handshake::nak);  // not configured
  CHECK(bench.port.in(1).handshake == Handshake::nak);
  CHECK(bench.port.in(2).handshake == Handshake::nak);
  check_alive(bench);
  CHECK(bench.port.in(0).handshake == Handshake::nak);
  CHECK(bench.port.out(0, {}) == Handshake::nak);
}

TEST_CASE("reset in every stage of a control transfer") {
  for (int stage = 0; stage < 5; ++stage) {
    DeviceBench bench;
    bench.configure();
    const std::array<std::byte, 64> part{std::byte{0x11}};
    switch (stage) {
      case 0: bench.setup(request(0xA1, 1, 0x0311, 0, 4096)); break;
      case 1:
        bench.setup(request(0xA1, 1, 0x0311, 0, 4096));
        bench.port.in(0);
        break;
      case 2: bench.setup(set_parameters); break;
      case 3:
        bench.setup(set_parameters);
        bench.port.out(0, part);
        break;
      default: bench.setup(request(0x00, 9, 1, 0, 0)); break;
    }
    bench.port.reset();
    bench.device.poll();
    CHECK_FALSE(bench.device.configured());
    CHECK(bench.port.in(0).handshake == Handshake::nak);
    CHECK(bench.port.out(0, {}) == Handshake::nak);
    check_alive(bench);
    CHECK(bench.configure() == done_result);
    bench.run(20);
    bench.device.poll();
    CHECK(bench.port.in(1).data.size() == 64);
  }
}

TEST_CASE("SETUP at random moments of random transfers never leaves the device dumb") {
  DeviceBench bench;
  std::uint32_t random = 12345;
  const auto next = [&random](std::uint32_t bound) {
    random = random * 1664525u + 1013904223u;
    return (random >> 8) % bound;
  };
  constexpr std::uint8_t types[] = {0x00, 0x01, 0x02, 0x80, 0x81, 0x82, 0x21, 0xA1, 0xC0};
  constexpr std::uint16_t lengths[] = {0, 1, 8, 18, 63, 64, 65, 128, 776, 777, 65535};
  std::array<std::byte, 64> data{};
  int alive = 0;
  for (int i = 0; i < 4000; ++i) {
    const usb::SetupPacket packet = {types[next(sizeof types)], static_cast<std::uint8_t>(next(14)),
                                     static_cast<std::uint16_t>(next(2) ? next(4) << 8 | next(32) : next(65536)),
                                     static_cast<std::uint16_t>(next(4) ? next(3) : next(65536)), lengths[next(11)]};
    bench.port.setup(std::as_bytes(std::span(&packet, 1)));
    for (std::uint32_t step = next(30); step > 0; --step) {
      data[0] = static_cast<std::byte>(next(256));
      switch (next(6)) {
        case 0: bench.port.in(0); break;
        case 1: bench.port.out(0, std::span(data).first(next(65))); break;
        case 2: bench.port.in(1 + static_cast<std::uint8_t>(next(2))); break;
        case 3: bench.port.out(1, std::span(data).first(next(65))); break;
        case 4: bench.run(next(30)); break;
        default: bench.device.poll(); break;
      }
    }
    switch (next(200)) {
      case 0: bench.port.reset(); break;
      case 1: bench.port.suspend(); break;
      case 2: bench.port.resume(); break;
      default: break;
    }
    if (i % 20 == 0) {
      while (!bench.port.idle()) bench.device.poll();
      const ControlResult result = bench.get_descriptor(0x0100, 18);
      alive += result.data.size() == 18;
    }
  }
  CHECK(alive == 200);
}

}  // namespace inkwell
