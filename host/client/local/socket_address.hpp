// Text form of server addresses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "host/client/local/descriptor.hpp"

namespace inkwell::local {

/// The text is not a socket address. `what()` is a sentence.
class BadSocketAddress : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A TCP port, or a Unix socket if there is a path.
struct SocketAddress {
  std::string host{};  ///< of a TCP port
  std::uint16_t port = 0;
  std::filesystem::path path{};

  bool is_unix() const { return !path.empty(); }
  /// "HOST:PORT", "[IPV6]:PORT" or "unix:PATH".
  std::string text() const;
  bool operator==(const SocketAddress&) const = default;
};

inline constexpr std::string_view unix_scheme = "unix:", this_computer = "127.0.0.1";

/// Parses HOST:PORT, [IPV6]:PORT, PORT of this computer, or unix:PATH. All programs use this syntax.
/// @throws BadSocketAddress.
SocketAddress parse_socket_address(std::string_view text);

/// Parses "unix:PATH". @throws BadSocketAddress if the system cannot use the path, or if the path contains a blank,
/// which separates addresses in a line.
SocketAddress unix_socket(std::string_view text);

/// Connects to a Unix socket. If no server answers, returns a closed descriptor and sets errno.
Descriptor connect_to(const std::filesystem::path& path);

}  // namespace inkwell::local
