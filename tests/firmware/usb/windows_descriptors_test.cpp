// Tests the descriptors from which Windows selects drivers, and the lengths in these descriptors.
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "protocol/usb_identity.hpp"

#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using test::Bytes;
using test::DeviceBench;
using test::request;
using test::stall_result;

namespace {

namespace identity = protocol::usb;

using View = std::span<const std::byte>;

unsigned byte_at(View bytes, std::size_t at) {
  REQUIRE(at < bytes.size());
  return static_cast<unsigned>(bytes[at]);
}
unsigned half_at(View bytes, std::size_t at) { return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8; }

void append(Bytes& to, std::initializer_list<unsigned> values) {
  for (const unsigned value : values) to.push_back(static_cast<std::byte>(value));
}
void append_utf16(Bytes& to, std::string_view text, unsigned zeros) {
  for (const char character : text) append(to, {static_cast<unsigned char>(character), 0u});
  to.resize(to.size() + 2 * zeros);
}

Bytes microsoft_set(DeviceBench& bench) { return bench.control(request(0xC0, 0x20, 0, 7, 512)).data; }
Bytes object_store(DeviceBench& bench) { return bench.get_descriptor(0x0F00, 255).data; }

/// Splits `whole` into its parts. A part starts with its length in one or two bytes. The parts must fill `whole`
/// exactly.
std::vector<View> parts_of(View whole, bool has_wide_length) {
  std::vector<View> parts;
  while (!whole.empty()) {
    const std::size_t length = has_wide_length ? half_at(whole, 0) : byte_at(whole, 0);
    REQUIRE(length >= 2);
    REQUIRE(length <= whole.size());
    parts.push_back(whole.first(length));
    whole = whole.subspan(length);
  }
  return parts;
}

/// Returns the subsets of this type with their headers. The length in a header includes the header and the content of
/// the subset (Microsoft OS 2.0 Descriptors Specification, tables 11 and 12). The subsets must fill `whole` exactly.
std::vector<View> subsets_of(View whole, unsigned type) {
  std::vector<View> subsets;
  while (!whole.empty()) {
    REQUIRE(half_at(whole, 0) == 8);
    REQUIRE(half_at(whole, 2) == type);
    const std::size_t total = half_at(whole, 6);
    REQUIRE(total > 8);
    REQUIRE(total <= whole.size());
    subsets.push_back(whole.first(total));
    whole = whole.subspan(total);
  }
  return subsets;
}

}  // namespace

TEST_CASE("the descriptors by which Windows finds WinUSB, byte for byte") {
  DeviceBench bench;
  Bytes store;
  append(store, {5,    0x0F, 40,   0,    2,                       // two capabilities
                 7,    0x10, 2,    0,    0,    0,    0,           // USB 2.0 extension, without attributes
                 28,   0x10, 5,    0,                             // platform capability
                 0xDF, 0x60, 0xDD, 0xD8, 0x89, 0x45, 0xC7, 0x4C,  // {D8DD60DF-4589-4CC7-9CD2-659D9E648A9F}
                 0x9C, 0xD2, 0x65, 0x9D, 0x9E, 0x64, 0x8A, 0x9F,  //
                 0x00, 0x00, 0x03, 0x06, 0x52, 0x01, 0x20, 0});
  CHECK(object_store(bench) == store);
  Bytes set;
  append(set, {10, 0, 0, 0, 0x00, 0x00, 0x03, 0x06, 0x52, 0x01,  // set
               8, 0, 1, 0, 0, 0, 0x48, 0x01});                   // configuration
  const std::pair<unsigned, std::string_view> functions[] = {{1, "{5A1E7D6B-3C0F-4E59-9B7C-0D2B6C1F8A44}"},
                                                             {3, "{EC396C1F-BD53-4F5A-A880-E944C0308F12}"}};
  for (const auto& [interface, guid] : functions) {
    append(set, {8, 0, 2, 0, interface, 0, 160, 0});
    append(set, {20, 0, 3, 0, 'W', 'I', 'N', 'U', 'S', 'B', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    append(set, {132, 0, 4, 0, 7, 0, 42, 0});
    append_utf16(set, "DeviceInterfaceGUIDs", 1);
    append(set, {80, 0});
    append_utf16(set, guid, 2);
  }
  CHECK(microsoft_set(bench) == set);
}

TEST_CASE("every nested length of the Microsoft set is that of its parts, and the scope and DFU have WinUSB") {
  DeviceBench bench;
  const Bytes all = microsoft_set(bench);
  const View set(all);
  CHECK(half_at(set, 0) == 10);
  CHECK(half_at(set, 8) == set.size());
  const auto configurations = subsets_of(set.subspan(10), 1);
  REQUIRE(configurations.size() == 1);
  CHECK(byte_at(configurations[0], 4) == 0);  // the first configuration, counted from 0
  std::map<unsigned, Bytes> guids;
  for (const View function : subsets_of(configurations[0].subspan(8), 2)) {
    const auto features = parts_of(function.subspan(8), true);
    REQUIRE(features.size() == 2);
    CHECK(features[0].size() == 20);
    CHECK(half_at(features[0], 2) == 3);  // compatible id
    CHECK(half_at(features[1], 2) == 4);  // registry property
    const std::size_t name_size = half_at(features[1], 6);
    const std::size_t value_at = 8 + name_size + 2;
    REQUIRE(value_at + half_at(features[1], 8 + name_size) == features[1].size());
    const View value = features[1].subspan(value_at);
    // An empty text ends a list of texts.
    CHECK(half_at(value, value.size() - 2) == 0);
    CHECK(half_at(value, value.size() - 4) == 0);
    CHECK(half_at(value, value.size() - 6) != 0);
    guids[byte_at(function, 4)] = Bytes(value.begin(), value.end());
  }
  REQUIRE(guids.size() == 2);
  REQUIRE(guids.contains(identity::scope_interface));
  REQUIRE(guids.contains(identity::firmware_update_interface));
  CHECK(guids[identity::scope_interface] != guids[identity::firmware_update_interface]);
}

TEST_CASE("every nested length of the binary object store is that of its parts, and it names the Microsoft set") {
  DeviceBench bench;
  const Bytes all = object_store(bench);
  const View store(all);
  CHECK(byte_at(store, 0) == 5);
  CHECK(half_at(store, 2) == store.size());
  const auto capabilities = parts_of(store.subspan(5), false);
  REQUIRE(capabilities.size() == byte_at(store, 4));
  std::vector<unsigned> types;
  for (const View capability : capabilities) {
    CHECK(byte_at(capability, 1) == 0x10);
    types.push_back(byte_at(capability, 2));
    if (types.back() != 5) continue;
    const std::size_t set_size_at = capability.size() - 4;
    CHECK(half_at(capability, set_size_at) == microsoft_set(bench).size());
    CHECK(byte_at(capability, set_size_at + 2) == 0x20);
  }
  CHECK(types == std::vector<unsigned>{2, 5});
}

TEST_CASE("every nested length and count of the configuration is that of its parts") {
  DeviceBench bench;
  const Bytes all = bench.get_descriptor(0x0200, 512).data;
  const View configuration(all);
  CHECK(half_at(configuration, 2) == configuration.size());
  unsigned interfaces = 0, endpoints_left = 0;
  for (const View part : parts_of(configuration, false)) {
    const unsigned type = byte_at(part, 1);
    if (type == 4) {
      CHECK(endpoints_left == 0);
      CHECK(byte_at(part, 2) == interfaces++);
      endpoints_left = byte_at(part, 4);
    } else if (type == 5) {
      REQUIRE(endpoints_left > 0);
      --endpoints_left;
    } else if (type == 0x21 && byte_at(part, 6) == 0x22) {
      const auto number = static_cast<std::uint16_t>(interfaces - 1);
      CHECK(half_at(part, 7) == bench.get_descriptor(0x2200, 4096, 1, number).data.size());
    }
  }
  CHECK(endpoints_left == 0);
  CHECK(interfaces == byte_at(configuration, 4));
}

TEST_CASE("the descriptors for Windows are given for their own request only") {
  DeviceBench bench;
  CHECK(bench.control(request(0xC0, 0x20, 0, 8, 512)) == stall_result);
  CHECK(bench.control(request(0xC0, 0x21, 0, 7, 512)) == stall_result);
  CHECK(bench.control(request(0x40, 0x20, 0, 7, 0)) == stall_result);
}

}  // namespace inkwell
