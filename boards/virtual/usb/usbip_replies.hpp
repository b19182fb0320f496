// Between USB/IP and the host controller: commands become transfers, descriptions and results become replies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <usbip/messages.hpp>
#include <virtual_usb/descriptors.hpp>
#include <virtual_usb/urb.hpp>

namespace inkwell::virtual_board {

/// What the server calls the one device that it exports.
inline constexpr char exported_bus_id[] = "1-1";
/// Longest transfer that is accepted, that of Linux' usbfs.
inline constexpr std::uint32_t transfer_maximum = 16u << 20;

/// Throws std::runtime_error with what is wrong if the header makes no sense for the exported device.
void check_transfer(const usbip::TransferHeader& header);
/// Packets that an isochronous transfer announces; they follow its data. Throws std::runtime_error if there are more
/// than Linux would send.
std::size_t packet_count_of(const usbip::Submit& submit);
/// The transfer that is asked for, without its data and packets. Throws std::runtime_error if it cannot be carried out.
Urb transfer_of(const usbip::Submit& submit);

void append_device_list(std::vector<std::byte>& out, const DeviceDescription* device);
void append_import_refused(std::vector<std::byte>& out, usbip::OperationStatus status);
void append_imported(std::vector<std::byte>& out, const DeviceDescription& device);
void append_submitted(std::vector<std::byte>& out, const Urb& urb, std::int32_t status);
void append_unlinked(std::vector<std::byte>& out, std::uint32_t sequence, std::int32_t status);

}  // namespace inkwell::virtual_board
