// The companion reads its interfaces and endpoints from the device's descriptors.
#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/device/usb_descriptors.hpp"
#include "tests/failure.hpp"

using namespace inkwell;
using device::parse_configuration;
using tests::contains;
using tests::message_of;

namespace {

using Bytes = std::vector<std::byte>;

Bytes joined(std::initializer_list<std::initializer_list<unsigned>> descriptors) {
  Bytes bytes;
  for (const auto& descriptor : descriptors)
    for (const unsigned byte : descriptor) bytes.push_back(static_cast<std::byte>(byte));
  return bytes;
}

constexpr std::initializer_list<unsigned> configuration_7{9, 2, 0, 0, 2, 7, 0, 0x80, 50};
constexpr std::initializer_list<unsigned> hid_interface_1{9, 4, 1, 0, 2, 3, 0, 0, 0};
constexpr std::initializer_list<unsigned> hid_descriptor{9, 0x21, 0x11, 1, 0, 1, 0x22, 64, 0};
constexpr std::initializer_list<unsigned> hid_in{7, 5, 0x84, 3, 64, 0, 1}, hid_out{7, 5, 0x05, 3, 64, 0, 1};
constexpr std::initializer_list<unsigned> vendor_interface_3{9, 4, 3, 0, 1, 0xFF, 0, 0, 0};
constexpr std::initializer_list<unsigned> scope_in{7, 5, 0x86, 2, 64, 0, 0};

bool refused_as(const Bytes& descriptor, const char* words) {
  return contains(message_of<device::Error>([&] { parse_configuration(descriptor); }), words);
}

}  // namespace

TEST_CASE("the USB layout is found in descriptors of any order and next to other descriptors") {
  const auto in_order =
      joined({configuration_7, hid_interface_1, hid_descriptor, hid_in, hid_out, vendor_interface_3, scope_in});
  const auto turned = joined({configuration_7,
                              {8, 11, 0, 2, 0, 0, 0, 0},  // interface association
                              vendor_interface_3,
                              {7, 5, 0x07, 2, 64, 0, 0},  // bulk OUT
                              {7, 5, 0x88, 3, 64, 0, 1},  // interrupt IN, of no HID interface
                              scope_in,
                              {7, 5, 0x0D, 2, 64, 0, 0},       // another bulk OUT after the correct endpoint
                              {9, 4, 5, 0, 1, 0x0A, 0, 0, 0},  // another class with both kinds of endpoint
                              {7, 5, 0x89, 2, 64, 0, 0},
                              {7, 5, 0x8A, 3, 64, 0, 1},
                              hid_interface_1,
                              {7, 5, 0x8B, 2, 64, 0, 0},  // bulk IN, of no vendor interface
                              hid_out,
                              {7, 5, 0x84, 0x13, 64, 0, 1},  // interrupt IN with usage bits in its attributes
                              {9, 4, 6, 0, 1, 3, 0, 0, 0},   // a second HID interface that belongs to the controller
                              {7, 5, 0x8C, 3, 64, 0, 8}});
  for (const auto& descriptor : {in_order, turned}) {
    const auto layout = parse_configuration(descriptor);
    CHECK(layout.configuration == 7);
    CHECK(layout.hid_interface == 1);
    CHECK(layout.hid_in_endpoint == 0x84);
    CHECK(layout.hid_out_endpoint == 0x05);
    CHECK(layout.scope_interface == 3);
    CHECK(layout.scope_in_endpoint == 0x86);
  }
}

TEST_CASE("a damaged configuration descriptor is refused, wherever the damage is") {
  const auto valid =
      joined({configuration_7, hid_interface_1, hid_descriptor, hid_in, hid_out, vendor_interface_3, scope_in});
  CHECK(refused_as({}, "damaged"));
  CHECK(refused_as(Bytes(valid.begin(), valid.begin() + 8), "damaged"));
  auto other_type = valid;
  other_type[1] = std::byte{1};
  CHECK(refused_as(other_type, "damaged"));
  for (const std::size_t at : {0u, 9u, 18u, 27u, 34u, 41u, 50u}) {  // offset of each descriptor's length
    for (const unsigned length : {0u, 1u, 255u}) {
      auto damaged = valid;
      damaged[at] = static_cast<std::byte>(length);
      CHECK(refused_as(damaged, "damaged"));
    }
  }
  auto cut = valid;
  cut.pop_back();
  CHECK(refused_as(cut, "damaged"));
  for (std::size_t size = 0; size < valid.size(); ++size)  // never reads beyond the end and always throws a message
    CHECK_THROWS_AS(parse_configuration({valid.data(), size}), device::Error);
}

TEST_CASE("descriptors that are shorter than their kind count for nothing") {
  CHECK(refused_as(joined({configuration_7, {8, 4, 1, 0, 2, 3, 0, 0}, hid_in, hid_out, vendor_interface_3, scope_in}),
                   "HID"));
  CHECK(refused_as(
      joined({configuration_7, hid_interface_1, hid_in, hid_out, vendor_interface_3, {6, 5, 0x86, 2, 64, 0}}),
      "scope"));
}

TEST_CASE("a device without one of the three endpoints is refused by the one it lacks") {
  CHECK(refused_as(joined({configuration_7, hid_interface_1, hid_out, vendor_interface_3, scope_in}), "HID"));
  CHECK(refused_as(joined({configuration_7, hid_interface_1, hid_in, vendor_interface_3, scope_in}), "HID"));
  CHECK(refused_as(joined({configuration_7, hid_interface_1, hid_in, hid_out, vendor_interface_3}), "scope"));
}

TEST_CASE(
    "strings: each UTF-16 character outside ASCII becomes a question mark, and a damaged string is shortened or "
    "empty") {
  CHECK(device::parse_string(joined({{10, 3, 'A', 0, 0xB5, 0, 'z', 0x30, '~', 0}})) == "A??~");
  CHECK(device::parse_string(joined({{5, 3, 'A', 0, 'B'}})) == "A");  // half a character
  CHECK(device::parse_string(joined({{4, 2, 'A', 0}})) == "");
  CHECK(device::parse_string({}) == "");
}

TEST_CASE("setup packets lie as USB has them") {
  using device::setup::DescriptorType;
  const auto lies_as = [](const device::Setup& setup, const std::array<std::uint8_t, 8>& expected) {
    return std::bit_cast<std::array<std::uint8_t, 8>>(setup) == expected;
  };
  using namespace device::setup;
  CHECK(lies_as(get_descriptor(DescriptorType::device, 0, 18), {0x80, 6, 0, 1, 0, 0, 18, 0}));
  CHECK(lies_as(get_descriptor(DescriptorType::configuration, 0, 1024), {0x80, 6, 0, 2, 0, 0, 0, 4}));
  CHECK(lies_as(get_descriptor(DescriptorType::string, 3, 255), {0x80, 6, 3, 3, 0x09, 0x04, 255, 0}));
  CHECK(lies_as(set_configuration(1), {0x00, 9, 1, 0, 0, 0, 0, 0}));
  CHECK(lies_as(get_feature_report(2, 0x10, 300), {0xA1, 0x01, 0x10, 3, 2, 0, 0x2C, 1}));
  CHECK(lies_as(set_feature_report(2, 0x11, 300), {0x21, 0x09, 0x11, 3, 2, 0, 0x2C, 1}));
}
