// Bytes both ways between the board and a program of this computer; what comes in waits for the simulation's thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace inkwell::virtual_board {

class ByteStream {
 public:
  /// So many bytes wait for `take`; the other end waits with the rest.
  static constexpr std::size_t unread_maximum = 64 * 1024;

  struct Arrived {
    bool connected = false, gone = false;  ///< since the last call; who came and went is both
    std::string bytes;
  };
  virtual ~ByteStream() = default;
  virtual Arrived take() = 0;
  /// What nobody reads is lost.
  virtual void send(std::string_view bytes) = 0;
};

}  // namespace inkwell::virtual_board
