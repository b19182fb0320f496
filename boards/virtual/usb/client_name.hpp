// Who a program at the other end of a loopback connection is, for sentences.
#pragma once

#include <cstdint>
#include <string>

namespace inkwell::virtual_board {

/// "drop-in-well (process 4711)" for the program of this computer whose socket has this TCP port of 127.0.0.1; where
/// that can not be found out, what port it has.
std::string client_name(std::uint16_t port);

}  // namespace inkwell::virtual_board
