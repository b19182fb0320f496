// Messages of USB/IP 1.1.1 (Linux kernel documentation, usb/usbip_protocol), big-endian on the wire.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <virtual_usb/descriptors.hpp>
#include <virtual_usb/urb.hpp>

namespace inkwell::virtual_board::usbip {

inline constexpr std::uint16_t version = 0x0111;
inline constexpr std::size_t operation_bytes = 8;
inline constexpr std::size_t bus_id_bytes = 32;
inline constexpr std::size_t header_bytes = 48;
inline constexpr char bus_id[] = "1-1";
inline constexpr std::uint32_t bus_number = 1, device_number = 2;
/// How CMD_SUBMIT names the imported device.
inline constexpr std::uint32_t device_id = bus_number << 16 | device_number;
/// Longest transfer that is accepted, that of Linux' usbfs.
inline constexpr std::uint32_t transfer_maximum = 16u << 20;

enum class Operation : std::uint16_t { list_devices = 0x8005, import = 0x8003 };
enum class ImportStatus : std::uint32_t { success = 0, busy = 2, no_device = 4 };
enum class Command : std::uint32_t { submit = 1, unlink = 2 };

struct OperationHeader {
  std::uint16_t version;
  std::uint16_t code;
};
OperationHeader read_operation(std::span<const std::byte, operation_bytes> bytes);
/// Cut at the first zero.
std::string read_bus_id(std::span<const std::byte, bus_id_bytes> bytes);

struct CommandHeader {
  Command command;
  Urb urb;                        ///< of a submit, without its data
  std::uint32_t unlink_sequence;  ///< of an unlink
  std::uint32_t data_bytes;       ///< that follow the header
  bool isochronous;
};
/// Throws std::runtime_error with what is wrong if the header makes no sense.
CommandHeader read_command(std::span<const std::byte, header_bytes> bytes);

void append_device_list(std::vector<std::byte>& out, const DeviceDescription* device);
void append_import_refused(std::vector<std::byte>& out, ImportStatus status);
void append_imported(std::vector<std::byte>& out, const DeviceDescription& device);
void append_submitted(std::vector<std::byte>& out, const Urb& urb, std::int32_t status);
void append_unlinked(std::vector<std::byte>& out, std::uint32_t sequence, std::int32_t status);

}  // namespace inkwell::virtual_board::usbip
