#include <initializer_list>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include <protocol/driver.hpp>
#include <protocol/store.hpp>

#include "device_bench.hpp"

namespace inkwell {

using test::Bytes;
using test::DeviceBench;
using test::request;
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
        bytes({9, 2,    100,  0,    4,  1,    0,    0xC0, 0,  // takes nothing from the bus
               9, 4,    0,    0,    2,  0x03, 0,    0,    4,  // HID
               9, 0x21, 0x11, 0x01, 0,  1,    0x22, 159,  0,  //
               7, 5,    0x81, 3,    64, 0,    1,              //
               7, 5,    0x01, 3,    64, 0,    1,              //
               9, 4,    1,    0,    1,  0xFF, 0,    0,    5,  // scope
               7, 5,    0x82, 2,    64, 0,    0,              //
               9, 4,    2,    0,    1,  0x03, 0,    0,    6,  // controller
               9, 0x21, 0x11, 0x01, 0,  1,    0x22, 79,   0,  //
               7, 5,    0x83, 3,    64, 0,    8,              //
               9, 4,    3,    0,    0,  0xFE, 1,    1,    7,  // firmware update
               9, 0x21, 0x0B, 0xFF, 0,  0,    0x08, 0x1A, 0x01}));
  CHECK(bench.get_descriptor(0x2100, 64, 1).data == bytes({9, 0x21, 0x11, 0x01, 0, 1, 0x22, 159, 0}));
  CHECK(bench.get_descriptor(0x2100, 64, 1, 2).data == bytes({9, 0x21, 0x11, 0x01, 0, 1, 0x22, 79, 0}));
}

TEST_CASE("the HID report descriptor, byte for byte but for the reports' sizes") {
  DeviceBench bench;
  const auto low = [](std::size_t size) { return static_cast<unsigned>(size - 1) & 0xFF; };
  const auto high = [](std::size_t size) { return static_cast<unsigned>(size - 1) >> 8; };
  using namespace protocol;
  const std::size_t pose = sizeof(PoseReport), command = sizeof(CommandReport), information = sizeof(InformationReport),
                    parameters = sizeof(ParametersReport), transaction = sizeof(TransactionReport),
                    frame = sizeof(FrameReport), force = sizeof(ForceReport), shapes = sizeof(ShapesReport),
                    law = force_law_report_maximum, box = sizeof(BlackBoxReport), rows = sizeof(BlackBoxRowsReport),
                    self_test = sizeof(SelfTestReport), store = sizeof(StoreReport), driver = sizeof(DriverReport),
                    results = sizeof(RequestResultsReport);
  CHECK(bench.get_descriptor(0x2200, 4096, 1).data == bytes({0x06,
                                                             0x00,
                                                             0xFF,
                                                             0x09,
                                                             0x01,
                                                             0xA1,
                                                             0x01,
                                                             0x15,
                                                             0x00,
                                                             0x26,
                                                             0xFF,
                                                             0x00,
                                                             0x75,
                                                             0x08,  //
                                                             0x85,
                                                             0x01,
                                                             0x09,
                                                             2,
                                                             0x96,
                                                             low(pose),
                                                             high(pose),
                                                             0x81,
                                                             0x02,  //
                                                             0x85,
                                                             0x02,
                                                             0x09,
                                                             3,
                                                             0x96,
                                                             low(command),
                                                             high(command),
                                                             0x91,
                                                             0x02,
                                                             0x85,
                                                             0x03,
                                                             0x09,
                                                             8,
                                                             0x96,
                                                             low(force),
                                                             high(force),
                                                             0x91,
                                                             0x02,  //
                                                             0x85,
                                                             0x10,
                                                             0x09,
                                                             4,
                                                             0x96,
                                                             low(information),
                                                             high(information),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x11,
                                                             0x09,
                                                             5,
                                                             0x96,
                                                             low(parameters),
                                                             high(parameters),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x12,
                                                             0x09,
                                                             6,
                                                             0x96,
                                                             low(transaction),
                                                             high(transaction),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x13,
                                                             0x09,
                                                             7,
                                                             0x96,
                                                             low(frame),
                                                             high(frame),
                                                             0xB1,
                                                             0x02,
                                                             0x85,
                                                             0x14,
                                                             0x09,
                                                             9,
                                                             0x96,
                                                             low(shapes),
                                                             high(shapes),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x15,
                                                             0x09,
                                                             10,
                                                             0x96,
                                                             low(law),
                                                             high(law),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x16,
                                                             0x09,
                                                             11,
                                                             0x96,
                                                             low(box),
                                                             high(box),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x17,
                                                             0x09,
                                                             12,
                                                             0x96,
                                                             low(rows),
                                                             high(rows),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x18,
                                                             0x09,
                                                             13,
                                                             0x96,
                                                             low(self_test),
                                                             high(self_test),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x19,
                                                             0x09,
                                                             14,
                                                             0x96,
                                                             low(store),
                                                             high(store),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x1A,
                                                             0x09,
                                                             15,
                                                             0x96,
                                                             low(parameters),
                                                             high(parameters),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x1B,
                                                             0x09,
                                                             16,
                                                             0x96,
                                                             low(driver),
                                                             high(driver),
                                                             0xB1,
                                                             0x02,  //
                                                             0x85,
                                                             0x1C,
                                                             0x09,
                                                             17,
                                                             0x96,
                                                             low(results),
                                                             high(results),
                                                             0xB1,
                                                             0x02,  //
                                                             0xC0}));
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

TEST_CASE("the descriptors by which Windows finds WinUSB, byte for byte") {
  DeviceBench bench;
  CHECK(bench.get_descriptor(0x0F00, 255).data ==
        bytes({5,    0x0F, 33,   0,    1,                       // one capability
               28,   0x10, 5,    0,                             // of the platform
               0xDF, 0x60, 0xDD, 0xD8, 0x89, 0x45, 0xC7, 0x4C,  // {D8DD60DF-4589-4CC7-9CD2-659D9E648A9F}
               0x9C, 0xD2, 0x65, 0x9D, 0x9E, 0x64, 0x8A, 0x9F,  //
               0x00, 0x00, 0x03, 0x06, 178,  0,    0x20, 0}));
  Bytes expected = bytes({10,  0, 0, 0, 0x00, 0x00, 0x03, 0x06, 178, 0,  // set
                          8,   0, 1, 0, 0,    0,    168,  0,             // configuration
                          8,   0, 2, 0, 1,    0,    160,  0,             // interface 1
                          20,  0, 3, 0, 'W',  'I',  'N',  'U',  'S', 'B', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                          132, 0, 4, 0, 7,    0,    42,   0});
  const auto append_utf16 = [&](std::string_view text, unsigned zeros) {
    for (const char character : text)
      expected.insert(expected.end(), {static_cast<std::byte>(character), std::byte{0}});
    expected.resize(expected.size() + 2 * zeros);
  };
  append_utf16("DeviceInterfaceGUIDs", 1);
  expected.insert(expected.end(), {std::byte{80}, std::byte{0}});
  append_utf16("{5A1E7D6B-3C0F-4E59-9B7C-0D2B6C1F8A44}", 2);
  CHECK(bench.control(request(0xC0, 0x20, 0, 7, 512)).data == expected);
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
  CHECK(bench.get_descriptor(0x0600, 10) == stall_result);  // device qualifier: there is no high speed
  CHECK(bench.get_descriptor(0x0700, 9) == stall_result);
  CHECK(bench.get_descriptor(0x0F01, 9) == stall_result);
  CHECK(bench.get_descriptor(0xFF00, 9) == stall_result);
  CHECK(bench.get_descriptor(0x2201, 9, 1) == stall_result);
  CHECK(bench.get_descriptor(0x2200, 9, 1, 1) == stall_result);  // the scope's interface has no reports
  CHECK(bench.get_descriptor(0x2200, 9, 1, 3) == stall_result);
  CHECK(bench.get_descriptor(0x2201, 9, 1, 2) == stall_result);
  CHECK(bench.get_descriptor(0x2300, 9, 1, 0) == stall_result);
  CHECK(bench.get_descriptor(0x0100, 18, 2) == stall_result);  // an endpoint has none
  // After all this the device still answers.
  CHECK(bench.get_descriptor(0x0100, 18).data.size() == 18);
}

TEST_CASE("the descriptors for Windows are given for their own request only") {
  DeviceBench bench;
  CHECK(bench.control(request(0xC0, 0x20, 0, 8, 512)) == stall_result);
  CHECK(bench.control(request(0xC0, 0x21, 0, 7, 512)) == stall_result);
  CHECK(bench.control(request(0x40, 0x20, 0, 7, 0)) == stall_result);
}

}  // namespace inkwell
