// Who a program at the other end of a connection on this computer is, for sentences.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace inkwell::virtual_board {

/// What a connection reveals of the other end without a search.
struct Peer {
  std::uint16_t port = 0;  ///< over TCP
  pid_t process = 0;       ///< over a Unix socket
};
Peer peer_of(int socket);

/// "drop-in-well (process 4711)", also for the program whose socket has this TCP port of 127.0.0.1; where that cannot
/// be found out, its port.
std::string client_name(Peer peer);

}  // namespace inkwell::virtual_board
