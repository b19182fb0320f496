// A connection of a client, over TCP or a Unix socket, closed with the object.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <device/socket_address.hpp>
#include <local/descriptor.hpp>
#include <process/fork.hpp>

namespace inkwell::device {

class Socket {
 public:
  /// Throws Error if nobody answers.
  explicit Socket(const SocketAddress& server);

  /// How long a receive waits for more bytes before it throws Error; without a limit it waits for ever, as at first.
  void wait_at_most(std::optional<std::chrono::milliseconds> limit);

  /// These throw Disconnected when the other end is gone.
  void send(std::span<const std::byte> bytes);
  void receive(std::span<std::byte> bytes);  ///< fills `bytes`
  std::size_t receive_some(std::span<std::byte> bytes);

  /// Ends a receive that waits in another thread.
  void shut_down();

 private:
  local::Descriptor descriptor_;
  process::OwnDescriptor own_;  ///< a child that shuts the socket down would end the parent's connection
  std::string peer_;
};

}  // namespace inkwell::device
