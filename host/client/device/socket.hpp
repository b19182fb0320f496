// A client connection over TCP or a Unix socket. The destructor closes it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "host/client/device/socket_address.hpp"
#include "host/client/local/descriptor.hpp"
#include "host/client/process/fork.hpp"

namespace inkwell::device {

class Socket {
 public:
  /// Throws Error if no server answers.
  explicit Socket(const SocketAddress& server);

  /// Sets the longest wait for received bytes. A longer wait throws Error. By default the wait is unlimited.
  void wait_at_most(std::optional<std::chrono::milliseconds> limit);

  /// send(), receive() and receive_some() throw Disconnected when the peer has closed the connection.
  void send(std::span<const std::byte> bytes);
  void receive(std::span<std::byte> bytes);  ///< fills `bytes`
  std::size_t receive_some(std::span<std::byte> bytes);

  /// Interrupts a receive() that waits in another thread.
  void shut_down();

 private:
  local::Descriptor descriptor_;
  process::OwnDescriptor own_;  ///< otherwise a forked child could shut down the parent's connection
  std::string peer_;
};

}  // namespace inkwell::device
