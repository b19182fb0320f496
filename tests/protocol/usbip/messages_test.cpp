// Compares the bytes of every message with the tables of the Linux kernel's Documentation/usb/usbip_protocol.rst.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "protocol/usbip/messages.hpp"

namespace inkwell {
namespace {

template <class Message, std::size_t size>
bool lies_as(const Message& message, const std::array<std::uint8_t, size>& expected) {
  static_assert(sizeof(Message) == size);
  const auto bytes = usbip::bytes_of(message);
  return std::equal(bytes.begin(), bytes.end(), expected.begin(),
                    [](std::byte byte, std::uint8_t value) { return byte == std::byte{value}; });
}

template <class Message>
std::uint8_t byte_at(const Message& message, std::size_t index) {
  return std::to_integer<std::uint8_t>(usbip::bytes_of(message)[index]);
}

}  // namespace

TEST_CASE("USB/IP: requests and replies before the import") {
  using usbip::Operation;
  using Bytes = std::array<std::uint8_t, 8>;
  CHECK(lies_as(usbip::OperationHeader{.operation = Operation::request_device_list},
                Bytes{0x01, 0x11, 0x80, 0x05, 0, 0, 0, 0}));
  CHECK(lies_as(usbip::OperationHeader{.operation = Operation::reply_import, .status = usbip::OperationStatus::busy},
                Bytes{0x01, 0x11, 0x00, 0x03, 0, 0, 0, 2}));
  CHECK(byte_at(usbip::OperationHeader{.status = usbip::OperationStatus::no_device}, 7) == 4);
  CHECK(lies_as(usbip::DeviceListReply{.device_count = 0x01020304},
                std::array<std::uint8_t, 12>{0x01, 0x11, 0x00, 0x05, 0, 0, 0, 0, 1, 2, 3, 4}));
  std::array<std::uint8_t, 40> import{0x01, 0x11, 0x80, 0x03, 0, 0, 0, 0, '1', '-', '1'};
  CHECK(lies_as(usbip::ImportRequest{.bus_id = {"1-1"}}, import));
}

TEST_CASE("USB/IP: a device and its interfaces") {
  usbip::Device device{.path = {"/sys/1-1"},
                       .bus_id = {"1-1"},
                       .bus_number = 0x11121314,
                       .device_number = 0x21222324,
                       .speed = usbip::Speed::full,
                       .vendor_id = 0x3132,
                       .product_id = 0x4142,
                       .device_release = 0x5152,
                       .device_class = 0x61,
                       .device_subclass = 0x62,
                       .device_protocol = 0x63,
                       .configuration = 0x64,
                       .configuration_count = 0x65,
                       .interface_count = 0x66};
  std::array<std::uint8_t, 312> expected{'/', 's', 'y', 's', '/', '1', '-', '1'};
  const std::array<std::uint8_t, 3> bus_id{'1', '-', '1'};
  std::copy(bus_id.begin(), bus_id.end(), expected.begin() + 256);
  const std::array<std::uint8_t, 24> numbers{0x11, 0x12, 0x13, 0x14, 0x21, 0x22, 0x23, 0x24, 0,    0,    0,    2,
                                             0x31, 0x32, 0x41, 0x42, 0x51, 0x52, 0x61, 0x62, 0x63, 0x64, 0x65, 0x66};
  std::copy(numbers.begin(), numbers.end(), expected.begin() + 288);
  CHECK(lies_as(device, expected));
  CHECK(lies_as(usbip::Interface{3, 1, 2}, std::array<std::uint8_t, 4>{3, 1, 2, 0}));
}

TEST_CASE("USB/IP: transfers") {
  using usbip::Direction;
  usbip::Submit submit{.transfer_flags = 0x31323334,
                       .length = 0x41424344,
                       .start_frame = 0x51525354,
                       .packet_count = usbip::not_isochronous,
                       .interval = 0x61626364,
                       .setup = {std::byte{0x80}, std::byte{6}, std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0},
                                 std::byte{18}, std::byte{0}}};
  submit.header.sequence = 0x01020304;
  submit.header.device = usbip::device_of(1, 2);
  submit.header.direction = Direction::in;
  submit.header.endpoint = 0x0F;
  CHECK(lies_as(submit,
                std::array<std::uint8_t, 48>{0,    0,    0,    1,    0x01, 0x02, 0x03, 0x04, 0,    1,    0,    2,     //
                                             0,    0,    0,    1,    0,    0,    0,    0x0F, 0x31, 0x32, 0x33, 0x34,  //
                                             0x41, 0x42, 0x43, 0x44, 0x51, 0x52, 0x53, 0x54, 0xFF, 0xFF, 0xFF, 0xFF,  //
                                             0x61, 0x62, 0x63, 0x64, 0x80, 6,    0,    1,    0,    0,    18,   0}));

  usbip::ReturnSubmit answer{.status = -32, .actual_length = 0x41424344, .error_count = 0x71727374};
  answer.header.sequence = 0x01020304;
  CHECK(lies_as(answer,
                std::array<std::uint8_t, 48>{0,    0,    0,    3,    0x01, 0x02, 0x03, 0x04, 0,    0,    0,    0,     //
                                             0,    0,    0,    0,    0,    0,    0,    0,    0xFF, 0xFF, 0xFF, 0xE0,  //
                                             0x41, 0x42, 0x43, 0x44, 0,    0,    0,    0,    0,    0,    0,    0,     //
                                             0x71, 0x72, 0x73, 0x74, 0,    0,    0,    0,    0,    0,    0,    0}));

  usbip::Unlink unlink{.unlinked_sequence = 0x01020304};
  unlink.header.sequence = 5;
  std::array<std::uint8_t, 48> expected{0, 0, 0, 2, 0, 0, 0, 5};
  std::copy_n(std::array<std::uint8_t, 4>{1, 2, 3, 4}.begin(), 4, expected.begin() + 20);
  CHECK(lies_as(unlink, expected));

  usbip::ReturnUnlink unlinked{.status = -104};
  unlinked.header.sequence = 5;
  expected = {0, 0, 0, 4, 0, 0, 0, 5};
  std::copy_n(std::array<std::uint8_t, 4>{0xFF, 0xFF, 0xFF, 0x98}.begin(), 4, expected.begin() + 20);
  CHECK(lies_as(unlinked, expected));
}

TEST_CASE("USB/IP: a written message is read back unchanged from any address") {
  usbip::Submit submit{.length = 0x8000'0001};
  submit.header.sequence = 77;
  std::array<std::byte, 49> buffer{};
  std::ranges::copy(usbip::bytes_of(submit), buffer.begin() + 1);
  const auto header = usbip::read<usbip::TransferHeader>(std::span(buffer).subspan(1));
  CHECK(header.command == usbip::Command::submit);
  CHECK(header.sequence == 77);
  CHECK(usbip::read<usbip::Submit>(std::span(buffer).subspan(1)).length == 0x8000'0001);
  CHECK(usbip::BigEndian<std::int32_t>(-71) == -71);
}

TEST_CASE("USB/IP: text ends with a zero however long it is, and without one at the end of its field") {
  const usbip::BusId cut("0123456789012345678901234567890123456789");
  CHECK(cut.view() == "0123456789012345678901234567890");
  CHECK(byte_at(cut, 31) == 0);
  std::array<std::byte, 32> full{};
  full.fill(std::byte{'x'});
  CHECK(usbip::read<usbip::BusId>(full).view().size() == 32);
}

}  // namespace inkwell
