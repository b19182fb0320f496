#include "socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <device/error.hpp>

namespace inkwell::device {

Socket::Socket(const std::string& host, std::uint16_t port) : peer_(fmt::format("{}:{}", host, port)) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int code = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); code != 0)
    throw Error(fmt::format("The host name {} is not known ({}). Check the spelling or give an address.", host,
                            gai_strerror(code)));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
  int reason = 0;
  for (const addrinfo* address = addresses.get(); address != nullptr; address = address->ai_next) {
    descriptor_ = socket(address->ai_family, address->ai_socktype | SOCK_CLOEXEC, address->ai_protocol);
    if (descriptor_ >= 0 && connect(descriptor_, address->ai_addr, address->ai_addrlen) == 0) break;
    reason = errno;
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
  }
  if (descriptor_ < 0)
    throw Error(fmt::format("Nothing answers at {} ({}). Start the virtual board, or check the port it printed.", peer_,
                            std::strerror(reason)));
  const int yes = 1;  // requests are small and waited for: sending them at once matters more than packing them
  setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

Socket::Socket(Socket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), peer_(std::move(other.peer_)) {}

Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(peer_, other.peer_);
  return *this;
}

void Socket::wait_at_most(std::optional<std::chrono::milliseconds> limit) {
  const auto microseconds = std::chrono::microseconds(limit.value_or(std::chrono::milliseconds(0))).count();
  const timeval wait{microseconds / 1'000'000, microseconds % 1'000'000};  // 0 is no limit
  setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
}

void Socket::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw Disconnected(fmt::format("The connection to {} broke. Start the board again.", peer_));
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

std::size_t Socket::receive_some(std::span<std::byte> bytes) {
  for (;;) {
    const ssize_t received = recv(descriptor_, bytes.data(), bytes.size(), 0);
    if (received > 0) return static_cast<std::size_t>(received);
    if (received < 0 && errno == EINTR) continue;
    if (received < 0 && errno == EAGAIN)
      throw Error(
          fmt::format("What listens at {} gives no answer. Check that this is the port that virtual-board printed "
                      "for this.",
                      peer_));
    throw Disconnected(fmt::format("The other end of {} closed the connection. Start the board again.", peer_));
  }
}

void Socket::receive(std::span<std::byte> bytes) {
  while (!bytes.empty()) bytes = bytes.subspan(receive_some(bytes));
}

void Socket::shut_down() { shutdown(descriptor_, SHUT_RDWR); }

}  // namespace inkwell::device
