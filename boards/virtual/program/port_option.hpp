// Where a port of the board is to listen, as its option says.
#pragma once

#include <optional>
#include <string>

#include <local/private_folder.hpp>
#include <local/socket_address.hpp>

namespace inkwell::virtual_board {

/// A Unix socket without a path is one in a private folder.
struct PortOption {
  local::SocketAddress address{};
  bool is_private = false;
  /// Of "PORT", "unix:PATH" or "unix:". Throws std::invalid_argument with a sentence.
  static PortOption of(const std::string& text);
};

/// What the line "ready ..." says of a port: its number, or "unix:PATH".
std::string announced(const local::SocketAddress& address);

/// The folder of the private sockets, made once it is needed.
class PrivateSockets {
 public:
  /// `name` is the file's if the socket is private. Throws std::runtime_error with a sentence.
  local::SocketAddress address_of(const PortOption& option, const std::string& name);

 private:
  std::optional<local::PrivateFolder> folder_;
};

}  // namespace inkwell::virtual_board
