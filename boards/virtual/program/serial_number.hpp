// The chip's unique identifier (RM0090, "Unique device ID register"). The firmware derives the USB serial number from
// this identifier. Simultaneous boards have different identifiers. A restart with the same options does not change the
// identifier.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace inkwell::virtual_board {

using UniqueId = std::array<std::uint32_t, 3>;

/// Parses up to 24 hexadecimal digits in the format of the firmware. Throws std::invalid_argument with an error
/// sentence.
UniqueId unique_id_of(std::string_view serial_number);
UniqueId unique_id_of_seed(std::uint64_t seed);
/// Returns the same identifier for all notations of a path.
UniqueId unique_id_of_flash(const std::filesystem::path& file);
UniqueId unique_id_of_socket(const std::filesystem::path& file);
UniqueId unique_id_of_port(std::uint16_t usbip_port);
/// Fallback for boards without seed, file, socket and port.
UniqueId unique_id_of_process();

}  // namespace inkwell::virtual_board
