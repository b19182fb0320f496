// USB and HID descriptors.
#include <initializer_list>
#include <string>

#include <doctest/doctest.h>

#include "protocol/report_table.hpp"

#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using test::Bytes;
using test::DeviceBench;
using test::stall_result;

namespace {

Bytes bytes(std::initializer_list<unsigned> values) {
  Bytes result;
  for (const unsigned value : values) result.push_back(static_cast<std::byte>(value));
  return result;
}

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

}  // namespace

TEST_CASE("device and configuration, byte for byte") {
  DeviceBench bench;
  CHECK(bench.get_descriptor(0x0100, 18).data ==
        bytes({18, 1, 0x01, 0x02, 0, 0, 0, 64, 0x09, 0x12, 0x01, 0x00, 0x23, 0x01, 1, 2, 3, 1}));
  CHECK(bench.get_descriptor(0x0200, 512).data ==
        bytes({9, 2,    100,  0,    4,  1,    0,    0xC0, 0,  // draws no current from the bus
               9, 4,    0,    0,    2,  0x03, 0,    0,    4,  // HID
               9, 0x21, 0x11, 0x01, 0,  1,    0x22, 168,  0,  //
               7, 5,    0x81, 3,    64, 0,    1,              //
               7, 5,    0x01, 3,    64, 0,    1,              //
               9, 4,    1,    0,    1,  0xFF, 0,    0,    5,  // scope
               7, 5,    0x82, 2,    64, 0,    0,              //
               9, 4,    2,    0,    1,  0x03, 0,    0,    6,  // controller
               9, 0x21, 0x11, 0x01, 0,  1,    0x22, 79,   0,  //
               7, 5,    0x83, 3,    64, 0,    8,              //
               9, 4,    3,    0,    0,  0xFE, 1,    1,    7,  // firmware update
               9, 0x21, 0x0B, 0xFF, 0,  0,    0x08, 0x10, 0x01}));
  CHECK(bench.get_descriptor(0x2100, 64, 1).data == bytes({9, 0x21, 0x11, 0x01, 0, 1, 0x22, 168, 0}));
  CHECK(bench.get_descriptor(0x2100, 64, 1, 2).data == bytes({9, 0x21, 0x11, 0x01, 0, 1, 0x22, 79, 0}));
}

TEST_CASE("the HID report descriptor, byte for byte but for the reports' sizes") {
  using namespace protocol;
  const struct {
    unsigned id, usage, item;
    std::size_t size;
  } reports[] = {{0x01, 2, 0x81, sizeof(PoseReport)},           {0x02, 3, 0x91, sizeof(CommandReport)},
                 {0x03, 8, 0x91, sizeof(ForceReport)},          {0x04, 18, 0x91, sizeof(LocalModelReport)},
                 {0x10, 4, 0xB1, sizeof(InformationReport)},    {0x11, 5, 0xB1, sizeof(ParametersReport)},
                 {0x12, 6, 0xB1, sizeof(TransactionReport)},    {0x13, 7, 0xB1, sizeof(FrameReport)},
                 {0x14, 9, 0xB1, sizeof(ShapesReport)},         {0x15, 10, 0xB1, 2048},
                 {0x16, 11, 0xB1, sizeof(BlackBoxReport)},      {0x17, 12, 0xB1, sizeof(BlackBoxRowsReport)},
                 {0x18, 13, 0xB1, sizeof(SelfTestReport)},      {0x19, 14, 0xB1, sizeof(StoreReport)},
                 {0x1A, 15, 0xB1, sizeof(ParametersReport)},    {0x1B, 16, 0xB1, sizeof(DriverReport)},
                 {0x1C, 17, 0xB1, sizeof(RequestResultsReport)}};
  Bytes expected = bytes({0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08});
  for (const auto& row : reports) {
    const auto count = static_cast<unsigned>(row.size - 1);
    const Bytes items = bytes({0x85, row.id, 0x09, row.usage, 0x96, count & 0xFF, count >> 8, row.item, 0x02});
    expected.insert(expected.end(), items.begin(), items.end());
  }
  expected.push_back(std::byte{0xC0});
  DeviceBench bench;
  CHECK(bench.get_descriptor(0x2200, 4096, 1).data == expected);
}

TEST_CASE("the controller's report descriptor, byte for byte: a multi-axis controller with units") {
  DeviceBench bench;
  CHECK(bench.get_descriptor(0x2200, 4096, 1, 2).data ==
        bytes({0x05, 0x01, 0x09, 0x08, 0xA1, 0x01,                                      //
               0x16, 0x01, 0x80, 0x26, 0xFF, 0x7F, 0x36, 0x01, 0x80, 0x46, 0xFF, 0x7F,  //
               0x65, 0x11, 0x55, 0x0D, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x75, 16,   0x95, 3,    0x81,
               0x02,  // x, y, z
               0x65, 0x12, 0x55, 0x0C, 0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x75, 16,   0x95, 3,    0x81,
               0x02,                                                                             // Rx, Ry, Rz
               0x65, 0,    0x55, 0,    0x35, 0,    0x45, 0,    0x05, 0x09, 0x19, 1,    0x29, 2,  //
               0x15, 0,    0x25, 1,    0x75, 1,    0x95, 2,    0x81, 0x02, 0x95, 14,   0x81, 0x03, 0xC0}));
}

TEST_CASE("strings: language, names and serial number; no others") {
  DeviceBench bench;
  CHECK(half(bench.get_descriptor(0x0300, 255).data, 2) == 0x0409);
  CHECK(text(bench.get_descriptor(0x0301, 255).data) == "Inkwell");
  CHECK(text(bench.get_descriptor(0x0302, 255).data) == "Inkwell haptic arm");
  CHECK(text(bench.get_descriptor(0x0303, 255).data) == "0123456789ABCDEF01234567");
  CHECK(!text(bench.get_descriptor(0x0304, 255).data).empty());
  CHECK(!text(bench.get_descriptor(0x0305, 255).data).empty());
  CHECK(!text(bench.get_descriptor(0x0306, 255).data).empty());
  CHECK(!text(bench.get_descriptor(0x0307, 255).data).empty());
  for (unsigned index = 8; index < 256; ++index)
    CHECK(bench.get_descriptor(static_cast<std::uint16_t>(0x0300 | index), 255) == stall_result);
  for (const unsigned index : {0u, 3u}) {
    const Bytes string = bench.get_descriptor(static_cast<std::uint16_t>(0x0300 | index), 255).data;
    CHECK(byte(string, 0) == string.size());
    CHECK(byte(string, 1) == 3);
  }
}

TEST_CASE("descriptors that are not there are refused") {
  DeviceBench bench;
  CHECK(bench.get_descriptor(0x0101, 18) == stall_result);
  CHECK(bench.get_descriptor(0x0201, 9) == stall_result);
  CHECK(bench.get_descriptor(0x0600, 10) == stall_result);  // device qualifier: the device has no high speed
  CHECK(bench.get_descriptor(0x0700, 9) == stall_result);
  CHECK(bench.get_descriptor(0x0F01, 9) == stall_result);
  CHECK(bench.get_descriptor(0xFF00, 9) == stall_result);
  CHECK(bench.get_descriptor(0x2201, 9, 1) == stall_result);
  CHECK(bench.get_descriptor(0x2200, 9, 1, 1) == stall_result);  // the scope interface has no reports
  CHECK(bench.get_descriptor(0x2200, 9, 1, 3) == stall_result);
  CHECK(bench.get_descriptor(0x2201, 9, 1, 2) == stall_result);
  CHECK(bench.get_descriptor(0x2300, 9, 1, 0) == stall_result);
  CHECK(bench.get_descriptor(0x0100, 18, 2) == stall_result);  // an endpoint has no descriptors
  // The device works after all requests of this test.
  CHECK(bench.get_descriptor(0x0100, 18).data.size() == 18);
}

}  // namespace inkwell
