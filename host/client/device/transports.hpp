// The two kinds of transport. open_transport() selects one.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "host/client/device/transport.hpp"
#include "protocol/scope.hpp"

namespace inkwell::device {

inline constexpr char unplugged[] = "The device was unplugged. Connect the device again.";

/// Pending scope transfers. 128 KiB last more than 100 ms on a full-speed bus.
inline constexpr int bulk_transfers = 128 * 1024 / protocol::scope_frame_maximum;
/// Unread scope frames: 4 MiB.
inline constexpr std::size_t bulk_kept = 4 * 1024 * 1024 / protocol::scope_frame_maximum;

inline constexpr char scope_in_use[] =
    "The arm's scope is in use. Close the other program that records it or shows its signals.";

std::unique_ptr<Transport> open_usb_transport(const Endpoint& endpoint);
std::unique_ptr<Transport> open_usbip_transport(const Endpoint& endpoint);

/// The message for a user who may not open the device, with the required udev rule.
std::string permission_message(const std::string& path);

}  // namespace inkwell::device
