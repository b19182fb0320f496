#include <map>

#include <doctest/doctest.h>

#include "host.hpp"

namespace inkwell {

using test::Bench;
using test::Bytes;
using test::ControlResult;
using test::request;
using test::stall_result;

namespace {

unsigned byte(const Bytes& bytes, std::size_t at) {
  REQUIRE(at < bytes.size());
  return static_cast<unsigned>(bytes[at]);
}
unsigned half(const Bytes& bytes, std::size_t at) { return byte(bytes, at) | byte(bytes, at + 1) << 8; }

std::string text(const Bytes& descriptor) {
  std::string characters;
  for (std::size_t i = 2; i + 1 < descriptor.size(); i += 2) characters += static_cast<char>(half(descriptor, i));
  return characters;
}

/// Sizes in bytes of the reports in a HID report descriptor, their id included; key is main item and id.
std::map<std::pair<unsigned, unsigned>, std::size_t> report_sizes(const Bytes& descriptor) {
  std::map<std::pair<unsigned, unsigned>, std::size_t> sizes;
  unsigned id = 0, bits = 0, count = 0;
  int depth = 0;
  for (std::size_t at = 0; at < descriptor.size();) {
    const unsigned prefix = byte(descriptor, at++);
    REQUIRE(prefix != 0xFE);  // no long items
    const std::size_t size = (prefix & 3) == 3 ? 4 : prefix & 3;
    unsigned value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= byte(descriptor, at++) << (8 * i);
    switch (prefix & 0xFC) {
      case 0x74: bits = value; break;
      case 0x84: id = value; break;
      case 0x94: count = value; break;
      case 0xA0: ++depth; break;
      case 0xC0: --depth; break;
      case 0x80:
      case 0x90:
      case 0xB0:
        CHECK(depth == 1);
        CHECK(id != 0);
        sizes[{prefix & 0xFC, id}] += bits * count / 8 + 1;
        break;
      default: break;
    }
  }
  CHECK(depth == 0);
  return sizes;
}

}  // namespace

TEST_CASE("the device descriptor tells who it is") {
  Bench bench;
  const Bytes device = bench.get_descriptor(0x0100, 18).data;
  REQUIRE(device.size() == 18);
  CHECK(byte(device, 0) == 18);
  CHECK(byte(device, 1) == 1);
  CHECK(half(device, 2) == 0x0201);
  CHECK(byte(device, 7) == 64);
  CHECK(half(device, 8) == 0x1209);
  CHECK(half(device, 10) == 0x0001);
  CHECK(half(device, 12) == 0x0123);  // the firmware's version
  CHECK(byte(device, 17) == 1);
}

TEST_CASE("the configuration is well formed and holds the endpoints of the protocol") {
  Bench bench;
  const Bytes all = bench.get_descriptor(0x0200, 9).data;
  REQUIRE(all.size() == 9);
  const unsigned total = half(all, 2);
  const Bytes configuration = bench.get_descriptor(0x0200, 512).data;
  REQUIRE(configuration.size() == total);
  CHECK(byte(configuration, 4) == 2);
  CHECK(byte(configuration, 5) == 1);
  CHECK(byte(configuration, 7) == 0xC0);  // self-powered
  CHECK(byte(configuration, 8) == 0);     // takes nothing from the bus

  unsigned interfaces = 0, hid_report_size = 0;
  std::map<unsigned, unsigned> endpoint_types;
  std::size_t at = 0;
  while (at < total) {
    const unsigned length = byte(configuration, at);
    REQUIRE(length >= 2);
    switch (byte(configuration, at + 1)) {
      case 4:
        CHECK(byte(configuration, at + 2) == interfaces);
        CHECK(byte(configuration, at + 5) == (interfaces == 0 ? 0x03 : 0xFF));
        CHECK(byte(configuration, at + 4) == (interfaces == 0 ? 2 : 1));
        ++interfaces;
        break;
      case 5:
        endpoint_types[byte(configuration, at + 2)] = byte(configuration, at + 3);
        CHECK(half(configuration, at + 4) == 64);
        if (byte(configuration, at + 3) == 3) CHECK(byte(configuration, at + 6) == 1);
        break;
      case 0x21: hid_report_size = half(configuration, at + 7); break;
      default: break;
    }
    at += length;
  }
  CHECK(at == total);
  CHECK(interfaces == 2);
  CHECK(endpoint_types == std::map<unsigned, unsigned>{{0x81, 3}, {0x01, 3}, {0x82, 2}});
  CHECK(hid_report_size == bench.get_descriptor(0x2200, 512, 1).data.size());
  CHECK(bench.get_descriptor(0x2100, 64, 1).data.size() == 9);
}

TEST_CASE("the HID report descriptor has every report of the protocol in its size") {
  Bench bench;
  const Bytes descriptor = bench.get_descriptor(0x2200, 4096, 1).data;
  const std::map<std::pair<unsigned, unsigned>, std::size_t> expected = {
      {{0x80, 0x01}, sizeof(protocol::PoseReport)},
      {{0x90, 0x02}, sizeof(protocol::CommandReport)},
      {{0xB0, 0x10}, sizeof(protocol::InformationReport)},
      {{0xB0, 0x11}, sizeof(protocol::ParametersReport)},
      {{0xB0, 0x12}, sizeof(protocol::TransactionReport)}};
  CHECK(report_sizes(descriptor) == expected);
}

TEST_CASE("strings: language, names and serial number; no others") {
  Bench bench;
  CHECK(half(bench.get_descriptor(0x0300, 255).data, 2) == 0x0409);
  CHECK(text(bench.get_descriptor(0x0301, 255).data) == "Inkwell");
  CHECK(text(bench.get_descriptor(0x0302, 255).data) == "Inkwell haptic arm");
  CHECK(text(bench.get_descriptor(0x0303, 255).data) == "0123456789ABCDEF01234567");
  CHECK(!text(bench.get_descriptor(0x0304, 255).data).empty());
  CHECK(!text(bench.get_descriptor(0x0305, 255).data).empty());
  for (unsigned index = 6; index < 256; ++index)
    CHECK(bench.get_descriptor(static_cast<std::uint16_t>(0x0300 | index), 255) == stall_result);
  for (const unsigned index : {0u, 3u}) {
    const Bytes string = bench.get_descriptor(static_cast<std::uint16_t>(0x0300 | index), 255).data;
    CHECK(byte(string, 0) == string.size());
    CHECK(byte(string, 1) == 3);
  }
}

TEST_CASE("descriptors that are not there are refused") {
  Bench bench;
  CHECK(bench.get_descriptor(0x0101, 18) == stall_result);
  CHECK(bench.get_descriptor(0x0201, 9) == stall_result);
  CHECK(bench.get_descriptor(0x0600, 10) == stall_result);  // device qualifier: there is no high speed
  CHECK(bench.get_descriptor(0x0700, 9) == stall_result);
  CHECK(bench.get_descriptor(0x0F01, 9) == stall_result);
  CHECK(bench.get_descriptor(0xFF00, 9) == stall_result);
  CHECK(bench.get_descriptor(0x2201, 9, 1) == stall_result);
  CHECK(bench.get_descriptor(0x2200, 9, 1, 1) == stall_result);  // the scope's interface has no reports
  CHECK(bench.get_descriptor(0x2200, 9, 1, 2) == stall_result);
  CHECK(bench.get_descriptor(0x2300, 9, 1, 0) == stall_result);
  CHECK(bench.get_descriptor(0x0100, 18, 2) == stall_result);  // an endpoint has none
  // After all this the device still answers.
  CHECK(bench.get_descriptor(0x0100, 18).data.size() == 18);
}

TEST_CASE("Windows finds WinUSB for the scope's interface") {
  Bench bench;
  const Bytes store = bench.get_descriptor(0x0F00, 255).data;
  REQUIRE(store.size() == 33);
  CHECK(half(store, 2) == 33);
  CHECK(byte(store, 4) == 1);
  CHECK(byte(store, 7) == 5);
  const unsigned size = half(store, 29);
  const auto vendor_code = static_cast<std::uint8_t>(store[31]);

  const Bytes set = bench.control(request(0xC0, vendor_code, 0, 7, 512)).data;
  REQUIRE(set.size() == size);
  CHECK(half(set, 8) == size);
  // Headers nest: set, configuration, function; each tells the bytes up to its end.
  CHECK(half(set, 10 + 6) == size - 10);
  CHECK(byte(set, 18 + 4) == 1);  // interface 1
  CHECK(half(set, 18 + 6) == size - 18);
  CHECK(std::memcmp(set.data() + 30, "WINUSB\0\0", 8) == 0);
  std::size_t at = 0;
  while (at < size) at += half(set, at);
  CHECK(at == size);

  CHECK(bench.control(request(0xC0, vendor_code, 0, 8, 512)) == stall_result);
  CHECK(bench.control(request(0xC0, static_cast<std::uint8_t>(vendor_code + 1), 0, 7, 512)) == stall_result);
  CHECK(bench.control(request(0x40, vendor_code, 0, 7, 0)) == stall_result);
}

}  // namespace inkwell
