// Names of connected programs, for log lines and errors.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace inkwell::virtual_board {

/// Port or process of the remote end.
struct Peer {
  std::uint16_t port = 0;  ///< over TCP
  pid_t process = 0;       ///< over a Unix socket
};
Peer peer_of(int socket);

/// Returns, for example, "drop-in-well (process 4711)". For a TCP connection, searches for the process that uses the
/// port on 127.0.0.1. If the search fails, returns the port.
std::string client_name(Peer peer);

}  // namespace inkwell::virtual_board
