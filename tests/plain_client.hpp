// Sends and receives raw bytes over TCP on this computer or over a Unix socket.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "host/client/local/descriptor.hpp"
#include "host/client/local/socket_address.hpp"

namespace inkwell::tests {

class PlainClient {
 public:
  explicit PlainClient(const local::SocketAddress& server) : socket_(connected(server)) {
    if (!socket_.is_open()) throw std::runtime_error("nothing listens at " + server.text());
    const timeval limit{60, 0};
    ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  }
  int descriptor() const { return socket_.number(); }

  /// Returns false if the server has closed the connection.
  bool send(std::string_view text) {
    while (!text.empty()) {
      const ssize_t count = ::send(socket_.number(), text.data(), text.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// Returns `count` bytes, or fewer if the server closes the connection or sends nothing for a minute.
  std::string receive(std::size_t count) {
    std::string text;
    for (char letter = 0; text.size() < count && receive(letter);) text += letter;
    return text;
  }
  /// Returns the next line without its newline. The line is incomplete if the server closes the connection or sends
  /// nothing for a minute.
  std::string line() {
    std::string text;
    for (char letter = 0; receive(letter) && letter != '\n';) text += letter;
    return text;
  }
  /// Returns true if the server closes the connection before it sends a byte.
  bool is_closed() {
    char letter = 0;
    const ssize_t count = ::recv(socket_.number(), &letter, 1, 0);
    return count == 0 || (count < 0 && errno == ECONNRESET);
  }

 private:
  bool receive(char& letter) { return ::recv(socket_.number(), &letter, 1, 0) == 1; }

  static local::Descriptor connected(const local::SocketAddress& server) {
    if (server.is_unix()) return local::connect_to(server.path);
    local::Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(server.port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool is_connected =
        ::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    return is_connected ? std::move(socket) : local::Descriptor();
  }

  local::Descriptor socket_;
};

}  // namespace inkwell::tests
