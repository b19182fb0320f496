// Selects one of the two transports.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "host/client/device/transport.hpp"
#include "protocol/scope.hpp"

namespace inkwell::device {

inline constexpr char unplugged[] = "The device was unplugged. Connect the device again.";

/// Number of pending scope transfers. They have 128 KiB, which a full-speed bus needs more than 100 ms to fill.
inline constexpr int bulk_transfers = 128 * 1024 / protocol::scope_frame_maximum;
/// Largest number of unread scope frames (4 MiB).
inline constexpr std::size_t bulk_kept = 4 * 1024 * 1024 / protocol::scope_frame_maximum;

inline constexpr char scope_in_use[] =
    "The arm's scope is in use. Close the other program that records it or shows its signals.";

std::unique_ptr<Transport> open_usb_transport(const Endpoint& endpoint);
std::unique_ptr<Transport> open_usbip_transport(const Endpoint& endpoint);

/// Returns the message and the udev rule for a user without permission to open the device.
std::string permission_message(const std::string& path);

}  // namespace inkwell::device
