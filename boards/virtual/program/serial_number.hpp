// Whose chip it is: the unique identifier (RM0090, "Unique device ID register"), of which the firmware makes the serial
// number on USB. Boards that run at the same time are told apart by it, and one that is started again in the same way
// is the same one.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace inkwell::virtual_board {

using UniqueId = std::array<std::uint32_t, 3>;

/// Of up to 24 hexadecimal digits, as the firmware shows them. Throws std::invalid_argument with a sentence.
UniqueId unique_id_of(std::string_view serial_number);
UniqueId unique_id_of_seed(std::uint64_t seed);
/// The same for every way to write the file's name.
UniqueId unique_id_of_flash(const std::filesystem::path& file);
UniqueId unique_id_of_socket(const std::filesystem::path& file);
UniqueId unique_id_of_port(std::uint16_t usbip_port);
/// For want of anything that lasts longer.
UniqueId unique_id_of_process();

}  // namespace inkwell::virtual_board
