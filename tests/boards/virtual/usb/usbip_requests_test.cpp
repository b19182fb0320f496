#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "boards/virtual/usb/usbip_requests.hpp"
#include "tests/usbip_bytes.hpp"

using namespace inkwell;
using namespace inkwell::virtual_board;
using inkwell::tests::joined;

namespace {

usbip::Submit submit_out(std::uint32_t sequence) {
  usbip::Submit submit{.transfer_flags = 0x40, .length = sizeof(usbip::IsochronousPacket), .packet_count = 2};
  submit.header.sequence = sequence;
  submit.header.device = usbip::device_of(exported_bus_number, exported_device_number);
  submit.header.direction = usbip::Direction::out;
  submit.header.endpoint = 3;
  submit.setup[0] = std::byte{9};
  return submit;
}

}  // namespace

TEST_CASE("requests are found whole, with all that is in them, however their bytes arrive") {
  // The data has the length of a packet descriptor, but different contents.
  const usbip::IsochronousPacket data{.offset = 0x01020304, .length = 0x05060708};
  usbip::Unlink unlink{.unlinked_sequence = 7};
  unlink.header.sequence = 9;
  unlink.header.device = submit_out(0).header.device;
  const auto bytes =
      joined(usbip::OperationHeader{.operation = usbip::Operation::request_device_list},
             usbip::ImportRequest{.bus_id = {"1-1"}}, submit_out(7), data, usbip::IsochronousPacket{.length = 10},
             usbip::IsochronousPacket{.offset = 10, .length = 6}, unlink);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, bytes.size()}) {
    CAPTURE(piece);
    UsbIpRequests requests;
    std::vector<UsbIpRequests::Operation> operations;
    std::vector<UsbIpRequests::Transfer> transfers;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      requests.feed(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      while (operations.size() < 2) {
        auto operation = requests.take_operation();
        if (!operation) break;
        operations.push_back(*operation);
      }
      if (operations.size() < 2) continue;
      while (auto transfer = requests.take_transfer()) transfers.push_back(*transfer);
    }
    REQUIRE(operations.size() == 2);
    CHECK(std::holds_alternative<UsbIpRequests::ListDevices>(operations[0]));
    CHECK(std::get<UsbIpRequests::Import>(operations[1]).bus_id == "1-1");
    REQUIRE(transfers.size() == 2);
    const auto& urb = std::get<Urb>(transfers[0]);
    CHECK(urb.sequence == 7);
    CHECK(urb.endpoint == 3);
    CHECK_FALSE(urb.in);
    CHECK(urb.flags == 0x40);
    CHECK(urb.setup[0] == std::byte{9});
    CHECK(urb.data == joined(data));
    REQUIRE(urb.packets.size() == 2);
    CHECK(urb.packets[0].offset == 0);
    CHECK(urb.packets[0].length == 10);
    CHECK(urb.packets[1].offset == 10);
    CHECK(urb.packets[1].length == 6);
    CHECK(std::get<UsbIpRequests::Unlink>(transfers[1]).sequence == 9);
    CHECK(std::get<UsbIpRequests::Unlink>(transfers[1]).unlinked_sequence == 7);
  }
}
