// The chip's unique identifier (RM0090, "Unique device ID register"). The firmware derives the USB serial number from
// this identifier. The identifier distinguishes simultaneous boards, and a board restarted with the same options has
// the same identifier.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace inkwell::virtual_board {

using UniqueId = std::array<std::uint32_t, 3>;

/// Parses up to 24 hexadecimal digits in the firmware's format. Throws std::invalid_argument with a sentence.
UniqueId unique_id_of(std::string_view serial_number);
UniqueId unique_id_of_seed(std::uint64_t seed);
/// The result does not depend on the notation of the path.
UniqueId unique_id_of_flash(const std::filesystem::path& file);
UniqueId unique_id_of_socket(const std::filesystem::path& file);
UniqueId unique_id_of_port(std::uint16_t usbip_port);
/// Used if no source with a longer lifetime is available.
UniqueId unique_id_of_process();

}  // namespace inkwell::virtual_board
