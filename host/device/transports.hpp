// The two kinds of transport; open_transport chooses.
#pragma once

#include <memory>
#include <string>

#include <device/transport.hpp>

namespace inkwell::device {

inline constexpr char scope_in_use[] =
    "The arm's scope is in use. Close the other program that records it or shows its signals.";

std::unique_ptr<Transport> open_usb_transport(const Endpoint& endpoint);
std::unique_ptr<Transport> open_usbip_transport(const Endpoint& endpoint);

/// The sentence for a user who may not open the device, with the udev line that changes it.
std::string permission_message(const std::string& path);

}  // namespace inkwell::device
