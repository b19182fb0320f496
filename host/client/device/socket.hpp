// A client connection over TCP or a Unix socket.
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

  /// Limits the waiting time for received bytes. A time-out throws Error. By default there is no limit.
  void wait_at_most(std::optional<std::chrono::milliseconds> limit);

  /// These functions throw Disconnected after the peer has closed the connection.
  void send(std::span<const std::byte> bytes);
  void receive(std::span<std::byte> bytes);  ///< receives until `bytes` is full
  std::size_t receive_some(std::span<std::byte> bytes);

  /// Interrupts a receive() call of another thread.
  void shut_down();

 private:
  bool is_readable_in_time() const;

  local::Descriptor descriptor_;
  process::OwnDescriptor own_;  ///< closes the connection in forked children
  std::string peer_;
  std::optional<std::chrono::milliseconds> limit_;
};

}  // namespace inkwell::device
