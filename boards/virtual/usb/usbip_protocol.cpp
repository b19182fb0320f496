#include "usbip_protocol.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace inkwell::virtual_board::usbip {

namespace {

constexpr std::uint16_t reply_to_list = 0x0005, reply_to_import = 0x0003;
constexpr std::uint32_t reply_to_submit = 3, reply_to_unlink = 4;
constexpr std::uint32_t full_speed = 2;  // Linux' enum usb_device_speed
constexpr std::size_t path_bytes = 256;

std::uint32_t read_32(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::uint32_t>(bytes[at]) << 24 | std::to_integer<std::uint32_t>(bytes[at + 1]) << 16 |
         std::to_integer<std::uint32_t>(bytes[at + 2]) << 8 | std::to_integer<std::uint32_t>(bytes[at + 3]);
}

void append_8(std::vector<std::byte>& out, unsigned value) { out.push_back(std::byte(value & 0xFF)); }
void append_16(std::vector<std::byte>& out, unsigned value) {
  append_8(out, value >> 8);
  append_8(out, value);
}
void append_32(std::vector<std::byte>& out, std::uint32_t value) {
  append_16(out, value >> 16);
  append_16(out, value);
}
void append_text(std::vector<std::byte>& out, const char* text, std::size_t width) {
  const std::size_t begin = out.size();
  out.resize(begin + width);
  std::memcpy(out.data() + begin, text, std::min(std::strlen(text), width - 1));
}

void append_operation(std::vector<std::byte>& out, std::uint16_t code, ImportStatus status) {
  append_16(out, version);
  append_16(out, code);
  append_32(out, static_cast<std::uint32_t>(status));
}

void append_device(std::vector<std::byte>& out, const DeviceDescription& device) {
  append_text(out, "/sys/devices/platform/inkwell_virtual_board/usb1/1-1", path_bytes);
  append_text(out, bus_id, bus_id_bytes);
  append_32(out, bus_number);
  append_32(out, device_number);
  append_32(out, full_speed);
  append_16(out, device.vendor());
  append_16(out, device.product());
  append_16(out, device.release());
  for (const std::size_t index : {4, 5, 6}) append_8(out, device.byte(index));  // class, subclass, protocol
  append_8(out, 0);  // not configured: that is the importer's first task
  append_8(out, device.configuration_count());
  append_8(out, device.configurations.empty() ? 0 : static_cast<unsigned>(device.configurations[0].interfaces.size()));
}

void append_reply(std::vector<std::byte>& out, std::uint32_t reply, std::uint32_t sequence, std::int32_t status) {
  append_32(out, reply);
  append_32(out, sequence);
  for (int i = 0; i < 3; ++i) append_32(out, 0);  // device, direction and endpoint are not repeated
  append_32(out, static_cast<std::uint32_t>(status));
}

}  // namespace

OperationHeader read_operation(std::span<const std::byte, operation_bytes> bytes) {
  const std::uint32_t word = read_32(bytes, 0);
  return {static_cast<std::uint16_t>(word >> 16), static_cast<std::uint16_t>(word)};
}

std::string read_bus_id(std::span<const std::byte, bus_id_bytes> bytes) {
  const char* text = reinterpret_cast<const char*>(bytes.data());
  return std::string(text, strnlen(text, bytes.size()));
}

CommandHeader read_command(std::span<const std::byte, header_bytes> bytes) {
  CommandHeader header{};
  const std::uint32_t command = read_32(bytes, 0);
  header.urb.sequence = read_32(bytes, 4);
  if (read_32(bytes, 8) != device_id) throw std::runtime_error("the command is for another device");
  const std::uint32_t direction = read_32(bytes, 12);
  const std::uint32_t endpoint = read_32(bytes, 16);
  if (direction > 1) throw std::runtime_error("the direction of a transfer is neither OUT nor IN");
  if (endpoint > 15) throw std::runtime_error("an endpoint number is above 15");
  if (command == static_cast<std::uint32_t>(Command::unlink)) {
    header.command = Command::unlink;
    header.unlink_sequence = read_32(bytes, 20);
    return header;
  }
  if (command != static_cast<std::uint32_t>(Command::submit)) throw std::runtime_error("the command is unknown");
  header.command = Command::submit;
  Urb& urb = header.urb;
  urb.endpoint = static_cast<std::uint8_t>(endpoint);
  urb.in = direction == 1;
  urb.flags = read_32(bytes, 20);
  urb.length = read_32(bytes, 24);
  if (urb.length > transfer_maximum) throw std::runtime_error("a transfer is longer than 16 MiB");
  const std::uint32_t packets = read_32(bytes, 32);
  header.isochronous = packets != 0 && packets != 0xFFFF'FFFF;
  std::copy_n(bytes.begin() + 40, urb.setup.size(), urb.setup.begin());
  // The direction of a control transfer is what its request says; the two must not differ.
  const bool request_in = (urb.setup[0] & std::byte{0x80}) != std::byte{0};
  if (endpoint == 0 && urb.length > 0 && request_in != urb.in)
    throw std::runtime_error("the direction of a control transfer differs from its request");
  header.data_bytes = urb.in ? 0 : urb.length;
  return header;
}

void append_device_list(std::vector<std::byte>& out, const DeviceDescription* device) {
  append_operation(out, reply_to_list, ImportStatus::success);
  append_32(out, device == nullptr ? 0 : 1);
  if (device == nullptr) return;
  append_device(out, *device);
  if (device->configurations.empty()) return;
  for (const InterfaceDescription& interface : device->configurations[0].interfaces) {
    append_8(out, interface.interface_class);
    append_8(out, interface.interface_subclass);
    append_8(out, interface.interface_protocol);
    append_8(out, 0);
  }
}

void append_import_refused(std::vector<std::byte>& out, ImportStatus status) {
  append_operation(out, reply_to_import, status);
}

void append_imported(std::vector<std::byte>& out, const DeviceDescription& device) {
  append_operation(out, reply_to_import, ImportStatus::success);
  append_device(out, device);
}

void append_submitted(std::vector<std::byte>& out, const Urb& urb, std::int32_t status) {
  append_reply(out, reply_to_submit, urb.sequence, status);
  append_32(out, urb.actual_length());
  for (int i = 0; i < 5; ++i) append_32(out, 0);  // start frame, packets, errors of isochronous transfers; padding
  if (urb.in) out.insert(out.end(), urb.data.begin(), urb.data.end());
}

void append_unlinked(std::vector<std::byte>& out, std::uint32_t sequence, std::int32_t status) {
  append_reply(out, reply_to_unlink, sequence, status);
  for (int i = 0; i < 6; ++i) append_32(out, 0);
}

}  // namespace inkwell::virtual_board::usbip
