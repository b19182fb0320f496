#include "stream_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <utility>

#include "loopback.hpp"

namespace inkwell::virtual_board {

StreamServer::StreamServer(std::uint16_t port, std::string_view option, std::function<void()> on_arrival)
    : port_(port), listener_(listen_on_loopback(port_, option)), on_arrival_(std::move(on_arrival)) {
  thread_ = std::thread([this] { serve(); });
}

StreamServer::~StreamServer() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);
  }
  ::shutdown(listener_, SHUT_RDWR);
  thread_.join();
  ::close(listener_);
}

void StreamServer::serve() {
  for (;;) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    {
      const std::lock_guard lock(mutex_);
      if (closing_) {
        if (socket >= 0) ::close(socket);
        return;
      }
      if (socket >= 0) {
        client_ = socket;
        arrived_ = {true, false, {}};
      }
    }
    if (socket < 0) {
      if (errno != EINTR && errno != ECONNABORTED) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const timeval patience{2, 0};  // a client that does not read must not hold up the board
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    on_arrival_();
    std::array<char, 4096> chunk;
    for (;;) {
      const ssize_t received = ::recv(socket, chunk.data(), chunk.size(), 0);
      if (received < 0 && errno == EINTR) continue;
      if (received <= 0) break;
      {
        const std::lock_guard lock(mutex_);
        arrived_.bytes.append(chunk.data(), static_cast<std::size_t>(received));
      }
      on_arrival_();
    }
    {
      const std::lock_guard lock(mutex_);
      ::close(std::exchange(client_, -1));
      arrived_.gone = true;
    }
    on_arrival_();
  }
}

StreamServer::Arrived StreamServer::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(arrived_, {});
}

void StreamServer::send(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (client_ >= 0 && !bytes.empty() && !send_all(client_, bytes)) ::shutdown(client_, SHUT_RDWR);
}

}  // namespace inkwell::virtual_board
