// A socket that listens only for local programs.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string_view>

#include "host/client/local/descriptor.hpp"
#include "host/client/local/socket_address.hpp"

namespace inkwell::local {

/// Pause before the next accept if the system has refused to open another file.
inline constexpr std::chrono::milliseconds accept_rest{20};

/// A TCP port listens on 127.0.0.1, or on ::1 if that is the host of the address, where every user of this computer can
/// connect. Only the owner can connect to a Unix socket, because its mode is 0600 from the start.
class Listener {
 public:
  /// Port 0 selects a free port. A Unix socket from another program is replaced if this user owns the socket and no
  /// program listens on the socket.
  /// @throws std::runtime_error with a sentence that names `option`.
  Listener(SocketAddress where, std::string_view option);
  /// Removes the Unix socket.
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int descriptor() const { return socket_.number(); }
  const SocketAddress& address() const { return address_; }

 private:
  void listen_on_port(std::string_view option);
  void listen_on_path(std::string_view option);

  SocketAddress address_;
  Descriptor socket_;
  dev_t device_ = 0;  ///< device and inode of the Unix socket's file
  ino_t inode_ = 0;
};

/// Sends the complete text, or returns false.
bool send_all(int socket, std::string_view text);

}  // namespace inkwell::local
