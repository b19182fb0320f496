#include "boards/virtual/usb/usbip_replies.hpp"

#include "boards/virtual/usb/usbip_requests.hpp"

namespace inkwell::virtual_board {

namespace {

template <class Message>
void append(std::vector<std::byte>& out, const Message& message) {
  const auto bytes = usbip::bytes_of(message);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

usbip::Device describe(const DeviceDescription& device) {
  const auto& configurations = device.configurations;
  return {
      .path = {"/sys/devices/platform/inkwell_virtual_board/usb1/1-1"},
      .bus_id = {exported_bus_id},
      .bus_number = exported_bus_number,
      .device_number = exported_device_number,
      .speed = usbip::Speed::full,
      .vendor_id = device.vendor(),
      .product_id = device.product(),
      .device_release = device.release(),
      .device_class = device.byte(4),
      .device_subclass = device.byte(5),
      .device_protocol = device.byte(6),
      .configuration = 0,  // the importer sets the configuration
      .configuration_count = device.configuration_count(),
      .interface_count = static_cast<std::uint8_t>(configurations.empty() ? 0 : configurations[0].interfaces.size())};
}

}  // namespace

void append_device_list(std::vector<std::byte>& out, const DeviceDescription* device) {
  append(out, usbip::DeviceListReply{.device_count = device == nullptr ? 0u : 1u});
  if (device == nullptr) return;
  append(out, describe(*device));
  if (device->configurations.empty()) return;
  for (const InterfaceDescription& interface : device->configurations[0].interfaces)
    append(out,
           usbip::Interface{interface.interface_class, interface.interface_subclass, interface.interface_protocol});
}

void append_import_refused(std::vector<std::byte>& out, usbip::OperationStatus status) {
  append(out, usbip::OperationHeader{.operation = usbip::Operation::reply_import, .status = status});
}

void append_imported(std::vector<std::byte>& out, const DeviceDescription& device) {
  append(out, usbip::OperationHeader{.operation = usbip::Operation::reply_import});
  append(out, describe(device));
}

void append_submitted(std::vector<std::byte>& out, const Urb& urb, std::int32_t status) {
  usbip::ReturnSubmit answer{.status = status, .actual_length = urb.actual_length()};
  answer.header.sequence = urb.sequence;
  const auto packets = static_cast<std::uint32_t>(urb.packets.size());
  answer.packet_count = packets;
  answer.error_count = packets;
  append(out, answer);
  if (urb.in) out.insert(out.end(), urb.data.begin(), urb.data.end());
  for (const auto& packet : urb.packets)
    append(out, usbip::IsochronousPacket{.offset = packet.offset, .length = packet.length, .status = status});
}

void append_unlinked(std::vector<std::byte>& out, std::uint32_t sequence, std::int32_t status) {
  usbip::ReturnUnlink answer{.status = status};
  answer.header.sequence = sequence;
  append(out, answer);
}

}  // namespace inkwell::virtual_board
