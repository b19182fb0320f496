// A socket that listens for programs of this computer, and for no others.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string_view>

#include <local/descriptor.hpp>
#include <local/socket_address.hpp>

namespace inkwell::local {

/// How long no client is accepted after the system refused to open another file.
inline constexpr std::chrono::milliseconds accept_rest{20};

/// A TCP port listens on 127.0.0.1, where every user of this computer can connect. To a Unix socket only its own user
/// can: its mode is 0600 before anybody can connect.
class Listener {
 public:
  /// Port 0 becomes the free one that was found. A Unix socket that a program left behind is replaced, if it is this
  /// user's and no program listens there.
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
  dev_t device_ = 0;  ///< of the Unix socket's file, like the next
  ino_t inode_ = 0;
};

/// Sends all of it, or returns false.
bool send_all(int socket, std::string_view text);

}  // namespace inkwell::local
