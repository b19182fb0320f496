// The two kinds of link; open_link chooses.
#pragma once

#include <memory>
#include <string>

#include <device/link.hpp>

namespace inkwell::device {

std::unique_ptr<Link> open_usb_link(const Endpoint& endpoint);
std::unique_ptr<Link> open_usbip_link(const Endpoint& endpoint);

/// The sentence for a user who may not open the device, with the udev line that changes it.
std::string permission_message(const std::string& path);

}  // namespace inkwell::device
