// A byte stream between the board and a local program. Received bytes are queued for the simulation thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace inkwell::virtual_board {

class ByteStream {
 public:
  /// Largest number of queued bytes for take(). The sender is blocked while the queue is full.
  static constexpr std::size_t unread_maximum = 64 * 1024;

  struct Arrived {
    bool connected = false, gone = false;  ///< since the last call; both are true for a client that connected and
                                           ///< disconnected
    std::string bytes;
  };
  virtual ~ByteStream() = default;
  virtual Arrived take() = 0;
  /// Sends bytes to the local program. If no program is connected, the bytes are discarded.
  virtual void send(std::string_view bytes) = 0;
};

}  // namespace inkwell::virtual_board
