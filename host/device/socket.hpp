// A TCP connection of a client, closed with the object.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace inkwell::device {

class Socket {
 public:
  /// Throws Error if nobody answers.
  Socket(const std::string& host, std::uint16_t port);
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;

  /// How long a receive waits for more bytes before it throws Error; without a limit it waits for ever, as at first.
  void wait_at_most(std::optional<std::chrono::milliseconds> limit);

  /// These throw Disconnected when the other end is gone.
  void send(std::span<const std::byte> bytes);
  void receive(std::span<std::byte> bytes);  ///< fills `bytes`
  std::size_t receive_some(std::span<std::byte> bytes);

  /// Ends a receive that waits in another thread.
  void shut_down();

 private:
  int descriptor_ = -1;
  std::string peer_;
};

}  // namespace inkwell::device
