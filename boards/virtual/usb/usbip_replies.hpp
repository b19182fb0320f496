// Serializes the replies of the USB/IP server: device descriptions and transfer results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "boards/virtual/usb/descriptors.hpp"
#include "boards/virtual/usb/urb.hpp"
#include "protocol/usbip/messages.hpp"

namespace inkwell::virtual_board {

void append_device_list(std::vector<std::byte>& out, const DeviceDescription* device);
void append_import_refused(std::vector<std::byte>& out, usbip::OperationStatus status);
void append_imported(std::vector<std::byte>& out, const DeviceDescription& device);
void append_submitted(std::vector<std::byte>& out, const Urb& urb, std::int32_t status);
void append_unlinked(std::vector<std::byte>& out, std::uint32_t sequence, std::int32_t status);

}  // namespace inkwell::virtual_board
