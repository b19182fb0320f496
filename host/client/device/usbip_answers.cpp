#include "host/client/device/usbip_answers.hpp"

#include <cerrno>
#include <utility>

#include <fmt/format.h>

namespace inkwell::device {
namespace {

usbip::OperationHeader receive_reply(const ReceiveBytes& receive, usbip::Operation operation) {
  const auto reply = receive_message<usbip::OperationHeader>(receive);
  if (reply.version != usbip::protocol_version || reply.operation != operation)
    throw Error("The program at this port does not use USB/IP 1.1.1. Give the USB/IP port that virtual-board printed.");
  return reply;
}

}  // namespace

std::vector<UsbipDevice> receive_device_list(const ReceiveBytes& receive) {
  receive_reply(receive, usbip::Operation::reply_device_list);
  const std::uint32_t count = receive_message<usbip::Big32>(receive);
  if (count > listed_devices_maximum)
    throw Error(
        fmt::format("The USB/IP server lists {} devices, more than {}. Give the USB/IP port that virtual-board "
                    "printed.",
                    count, listed_devices_maximum));
  std::vector<UsbipDevice> devices;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto device = receive_message<usbip::Device>(receive);
    for (int j = 0; j < device.interface_count; ++j) receive_message<usbip::Interface>(receive);
    devices.push_back(
        {std::string(device.path.view()), std::string(device.bus_id.view()), device.vendor_id, device.product_id});
  }
  return devices;
}

std::optional<std::uint32_t> receive_import(const ReceiveBytes& receive) {
  const auto reply = receive_reply(receive, usbip::Operation::reply_import);
  if (reply.status != usbip::OperationStatus::success) return std::nullopt;
  const auto device = receive_message<usbip::Device>(receive);
  return usbip::device_of(device.bus_number, device.device_number);
}

std::size_t OpenTransfers::data_length_of(const usbip::ReturnSubmit& answer) const {
  if (answer.header.command == usbip::Command::return_unlink) return 0;
  if (answer.header.command != usbip::Command::return_submit)
    throw Disconnected("The USB/IP server sent an invalid message. Start the board again.");
  const auto found = transfers_.find(answer.header.sequence);
  if (found == transfers_.end() || answer.actual_length > found->second.length)
    throw Disconnected("The USB/IP server answered a transfer that was not requested. Start the board again.");
  return found->second.direction == usbip::Direction::in ? std::size_t{answer.actual_length} : 0;
}

std::optional<OpenTransfers::Ended> OpenTransfers::take(const usbip::ReturnSubmit& answer,
                                                        std::vector<std::byte> data) {
  std::uint32_t sequence = answer.header.sequence;
  UsbipCompletion completion{answer.status, answer.actual_length, std::move(data)};
  if (answer.header.command == usbip::Command::return_unlink) {
    const auto unlinked = unlinks_.extract(sequence);
    if (!unlinked) return std::nullopt;
    sequence = unlinked.mapped();
    completion = {-ECONNRESET, 0, {}};
  }
  auto transfer = transfers_.extract(sequence);
  if (!transfer) return std::nullopt;
  return Ended{std::move(transfer.mapped().on_completion), std::move(completion)};
}

std::vector<UsbipTransfer> OpenTransfers::take_all() {
  std::vector<UsbipTransfer> all;
  for (auto& [sequence, transfer] : transfers_) all.push_back(std::move(transfer));
  transfers_.clear();
  return all;
}

}  // namespace inkwell::device
