// Listening address of a port option.
#pragma once

#include <optional>
#include <string>

#include "host/client/local/private_folder.hpp"
#include "host/client/local/socket_address.hpp"

namespace inkwell::virtual_board {

/// Listening address. A Unix socket without a path is created in a private folder.
struct PortOption {
  local::SocketAddress address{};
  bool is_private = false;
  /// Parses "PORT", "unix:PATH" or "unix:". Throws std::invalid_argument with an error sentence.
  static PortOption of(const std::string& text);
};

/// Returns the port number or "unix:PATH" for the line "ready ...".
std::string announced(const local::SocketAddress& address);

/// Folder of the private sockets. The first use creates the folder.
class PrivateSockets {
 public:
  /// `name` is the file name of a private socket. Throws std::runtime_error with an error sentence.
  local::SocketAddress address_of(const PortOption& option, const std::string& name);

 private:
  std::optional<local::PrivateFolder> folder_;
};

}  // namespace inkwell::virtual_board
