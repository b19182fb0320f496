// Listening address of a port, from its option.
#pragma once

#include <optional>
#include <string>

#include <local/private_folder.hpp>
#include <local/socket_address.hpp>

namespace inkwell::virtual_board {

/// A Unix socket without a path is created in a private folder.
struct PortOption {
  local::SocketAddress address{};
  bool is_private = false;
  /// Parses "PORT", "unix:PATH" or "unix:". Throws std::invalid_argument with a sentence.
  static PortOption of(const std::string& text);
};

/// Text for a port in the line "ready ...": its number, or "unix:PATH".
std::string announced(const local::SocketAddress& address);

/// The folder of the private sockets, created at the first use.
class PrivateSockets {
 public:
  /// `name` is the file name of a private socket. Throws std::runtime_error with a sentence.
  local::SocketAddress address_of(const PortOption& option, const std::string& name);

 private:
  std::optional<local::PrivateFolder> folder_;
};

}  // namespace inkwell::virtual_board
