#include "host/client/device/socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "host/client/device/error.hpp"
#include "host/client/local/interruption.hpp"

namespace inkwell::device {

namespace {

/// Longest wait for a computer that does not answer.
constexpr int connect_limit_ms = 3000;

void limit_sends(int descriptor, int limit_ms) {
  const timeval wait{limit_ms / 1000, limit_ms % 1000 * 1000};  // 0 means no limit; connect() uses this limit too
  setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
}

/// If a signal interrupts connect(), this function waits for the connection.
bool connect_socket(int descriptor, const addrinfo& address) {
  limit_sends(descriptor, connect_limit_ms);
  if (connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) {
    limit_sends(descriptor, 0);
    return true;
  }
  if (errno == EINPROGRESS) errno = ETIMEDOUT;
  if (errno != EINTR) return false;
  limit_sends(descriptor, 0);
  pollfd connection{descriptor, POLLOUT, 0};
  if (local::repeat_interrupted([&] { return poll(&connection, 1, connect_limit_ms); }) == 0) {
    errno = ETIMEDOUT;
    return false;
  }
  int reason = 0;
  socklen_t size = sizeof reason;
  getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &reason, &size);
  errno = reason;
  return reason == 0;
}

/// If the connection fails, the returned descriptor is not open and errno is set.
local::Descriptor connect_to_port(const SocketAddress& server) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int code = local::repeat_interrupted(
      [&] { return getaddrinfo(server.host.c_str(), std::to_string(server.port).c_str(), &hints, &found); });
  if (code != 0)
    throw Error(fmt::format("The host name {} is not known ({}). Check the spelling or give an address.", server.host,
                            gai_strerror(code)));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
  int reason = 0;
  for (const addrinfo* address = addresses.get(); address != nullptr; address = address->ai_next) {
    local::Descriptor descriptor(socket(address->ai_family, address->ai_socktype | SOCK_CLOEXEC, address->ai_protocol));
    if (descriptor.is_open() && connect_socket(descriptor.number(), *address)) {
      const int yes = 1;  // avoids the delay for small requests
      setsockopt(descriptor.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      return descriptor;
    }
    reason = errno;
  }
  errno = reason;
  return local::Descriptor();
}

}  // namespace

namespace {

/// A board whose cable was unplugged closes the connection, too, and goes on.
std::string connection_lost(const std::string& peer) {
  return fmt::format(
      "The program at {} closed the connection. If the board still runs, plug its cable in, open the arm again and "
      "clear the fault. Otherwise start the board again.",
      peer);
}

}  // namespace

Socket::Socket(const SocketAddress& server)
    : descriptor_(server.is_unix() ? local::connect_to(server.path) : connect_to_port(server)), peer_(server.text()) {
  if (!descriptor_.is_open())
    throw Error(fmt::format("No program answers at {} ({}). Start the virtual board, or check the {} that it printed.",
                            peer_, std::strerror(errno), server.is_unix() ? "path" : "port"));
  own_ = process::OwnDescriptor(descriptor_.number());
}

void Socket::wait_at_most(std::optional<std::chrono::milliseconds> limit) { limit_ = limit; }

bool Socket::is_readable_in_time() const {
  if (!limit_) return true;
  pollfd input{descriptor_.number(), POLLIN, 0};
  return local::repeat_interrupted(*limit_, [&](std::chrono::milliseconds rest) {
           return poll(&input, 1, static_cast<int>(rest.count()));
         }) != 0;
}

void Socket::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = local::repeat_interrupted(
        [&] { return ::send(descriptor_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL); });
    if (sent <= 0) throw Disconnected(connection_lost(peer_));
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

std::size_t Socket::receive_some(std::span<std::byte> bytes) {
  if (!is_readable_in_time())
    throw Error(fmt::format(
        "The program at {} does not answer. Check that virtual-board printed this port for this connection.", peer_));
  const ssize_t received =
      local::repeat_interrupted([&] { return recv(descriptor_.number(), bytes.data(), bytes.size(), 0); });
  if (received > 0) return static_cast<std::size_t>(received);
  throw Disconnected(connection_lost(peer_));
}

void Socket::receive(std::span<std::byte> bytes) {
  while (!bytes.empty()) bytes = bytes.subspan(receive_some(bytes));
}

void Socket::shut_down() { shutdown(descriptor_.number(), SHUT_RDWR); }

}  // namespace inkwell::device
