#include "boards/virtual/usb/usbip_requests.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace inkwell::virtual_board {
namespace {

void check_transfer(const usbip::TransferHeader& header) {
  if (header.command != usbip::Command::submit && header.command != usbip::Command::unlink)
    throw std::runtime_error("the command is unknown");
  if (header.device != usbip::device_of(exported_bus_number, exported_device_number))
    throw std::runtime_error("the command is for another device");
  if (header.direction != usbip::Direction::out && header.direction != usbip::Direction::in)
    throw std::runtime_error("the direction of a transfer is neither OUT nor IN");
  if (header.endpoint > 15) throw std::runtime_error("an endpoint number is above 15");
}

/// Returns the number of packet descriptors after the data of an isochronous transfer.
std::size_t packet_count_of(const usbip::Submit& submit) {
  if (submit.packet_count == usbip::not_isochronous) return 0;
  if (submit.packet_count > packets_maximum)
    throw std::runtime_error("an isochronous transfer has more than " + std::to_string(packets_maximum) + " packets");
  return submit.packet_count;
}

/// Converts the request header to a transfer without data and packets.
Urb transfer_of(const usbip::Submit& submit) {
  Urb urb;
  urb.sequence = submit.header.sequence;
  urb.endpoint = static_cast<std::uint8_t>(submit.header.endpoint);
  urb.in = submit.header.direction == usbip::Direction::in;
  urb.flags = submit.transfer_flags;
  urb.length = submit.length;
  urb.setup = submit.setup;
  if (urb.length > transfer_maximum) throw std::runtime_error("a transfer is longer than 16 MiB");
  // The direction of a control transfer must match the direction bit in its SETUP packet.
  const bool request_in = (urb.setup[0] & std::byte{0x80}) != std::byte{0};
  if (urb.endpoint == 0 && urb.length > 0 && request_in != urb.in)
    throw std::runtime_error("the direction of a control transfer differs from its request");
  return urb;
}

}  // namespace

void UsbIpRequests::feed(std::span<const std::byte> bytes) {
  // Moves the remaining bytes to the start of the buffer only when half of the buffer is consumed, because moves are
  // slow.
  if (consumed_ * 2 >= received_.size()) {
    received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(consumed_));
    consumed_ = 0;
  }
  received_.insert(received_.end(), bytes.begin(), bytes.end());
}

/// Checks the version even if the header is incomplete, because a browser may send fewer bytes than a header.
void UsbIpRequests::check_version() const {
  const usbip::Big16 expected = usbip::protocol_version;
  const auto version = usbip::bytes_of(expected);
  const auto begin = rest().first(std::min(rest().size(), version.size()));
  if (!std::equal(begin.begin(), begin.end(), version.begin()))
    throw std::runtime_error("it does not speak USB/IP 1.1.1");
}

std::optional<UsbIpRequests::Operation> UsbIpRequests::take_operation() {
  check_version();
  if (rest().size() < sizeof(usbip::OperationHeader)) return std::nullopt;
  const auto header = usbip::read<usbip::OperationHeader>(rest());
  if (header.operation == usbip::Operation::request_device_list) {
    consumed_ += sizeof header;
    return ListDevices{};
  }
  if (header.operation != usbip::Operation::request_import)
    throw std::runtime_error("it requests an unknown operation");
  if (rest().size() < sizeof(usbip::ImportRequest)) return std::nullopt;
  const auto request = usbip::read<usbip::ImportRequest>(rest());
  consumed_ += sizeof request;
  return Import{std::string(request.bus_id.view())};
}

std::optional<UsbIpRequests::Transfer> UsbIpRequests::take_transfer() {
  static_assert(sizeof(usbip::Submit) == sizeof(usbip::Unlink));
  if (rest().size() < sizeof(usbip::Submit)) return std::nullopt;
  const auto header = usbip::read<usbip::TransferHeader>(rest());
  check_transfer(header);
  if (header.command == usbip::Command::unlink) {
    const auto unlink = usbip::read<usbip::Unlink>(rest());
    consumed_ += sizeof unlink;
    return Unlink{header.sequence, unlink.unlinked_sequence};
  }
  const auto submit = usbip::read<usbip::Submit>(rest());
  Urb urb = transfer_of(submit);
  const auto body = rest().subspan(sizeof submit);
  const std::size_t length = urb.in ? 0 : urb.length;
  const std::size_t packets = packet_count_of(submit);
  const std::size_t body_size = length + packets * sizeof(usbip::IsochronousPacket);
  if (body.size() < body_size) return std::nullopt;
  for (std::size_t i = 0; i < packets; ++i) {
    const auto packet =
        usbip::read<usbip::IsochronousPacket>(body.subspan(length + i * sizeof(usbip::IsochronousPacket)));
    urb.packets.push_back({packet.offset, packet.length});
  }
  urb.data.assign(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(length));
  consumed_ += sizeof submit + body_size;
  return urb;
}

}  // namespace inkwell::virtual_board
