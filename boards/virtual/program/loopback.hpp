// Listening for programs of this computer, and for no other.
#pragma once

#include <cstdint>
#include <string_view>

namespace inkwell::virtual_board {

/// A socket that listens on 127.0.0.1. `port` 0 becomes the free one that was found.
/// @throws std::runtime_error with a sentence that names `option` if the port cannot be had.
int listen_on_loopback(std::uint16_t& port, std::string_view option);

/// Sends all of it, or returns false.
bool send_all(int socket, std::string_view text);

}  // namespace inkwell::virtual_board
