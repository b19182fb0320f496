#include "boards/virtual/program/stream_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <iterator>
#include <utility>

#include "host/client/local/interruption.hpp"

namespace inkwell::virtual_board {
namespace {

using namespace std::chrono_literals;

constexpr auto poll_interval = 100ms;  // checks whether a client with unread bytes has disconnected

}  // namespace

bool may_be_gdb(std::string_view bytes) {
  constexpr std::string_view begins{"+-$\x03"};
  return bytes.empty() || begins.find(bytes.front()) != std::string_view::npos;
}

bool may_be_terminal(std::string_view bytes) {
  constexpr std::string_view begins[] = {"GET ",     "POST ",  "HEAD ",  "PUT ", "DELETE ", "OPTIONS ",
                                         "CONNECT ", "TRACE ", "PATCH ", "PRI ", "\x16\x03"};
  return std::ranges::none_of(begins, [&](std::string_view begin) { return bytes.starts_with(begin); });
}

StreamServer::StreamServer(const local::SocketAddress& where, std::string_view option, FirstBytes welcome,
                           std::function<void()> on_arrival)
    : listener_(where, option), welcome_(welcome), on_arrival_(std::move(on_arrival)) {
  thread_ = std::thread([this] { serve(); });
}

StreamServer::~StreamServer() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    if (client_.is_open()) ::shutdown(client_.number(), SHUT_RDWR);
  }
  room_.notify_one();
  ::shutdown(listener_.descriptor(), SHUT_RDWR);
  thread_.join();
}

void StreamServer::serve() {
  for (;;) {
    local::Descriptor socket(
        local::repeat_interrupted([&] { return ::accept4(listener_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC); }));
    const bool has_failed = !socket.is_open() && errno != ECONNABORTED;
    const int client = socket.number();
    {
      const std::lock_guard lock(mutex_);
      if (closing_) return;
      client_ = std::move(socket);
      if (client >= 0) arrived_.bytes.clear();  // bytes of the previous client
    }
    if (has_failed) std::this_thread::sleep_for(local::accept_rest);
    if (client < 0) continue;
    const int on = 1;
    ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const timeval patience{2, 0};  // a client that does not read must not block the board
    ::setsockopt(client, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    receive_from(client);
  }
}

void StreamServer::receive_from(int client) {
  std::array<char, 4096> chunk;
  bool is_welcome = false;
  while (wait_for_room(client)) {
    const ssize_t count = local::repeat_interrupted([&] { return ::recv(client, chunk.data(), chunk.size(), 0); });
    if (count <= 0) break;
    const std::string_view bytes(chunk.data(), static_cast<std::size_t>(count));
    // One check is sufficient, because a browser sends the start of its request in one piece.
    if (!is_welcome && !welcome_(bytes)) break;
    {
      const std::lock_guard lock(mutex_);
      if (!std::exchange(is_welcome, true)) arrived_ = {true, false, {}};
      arrived_.bytes += bytes;
    }
    on_arrival_();
  }
  {
    const std::lock_guard lock(mutex_);
    client_ = local::Descriptor();
    if (!is_welcome) return;
    arrived_.gone = true;
  }
  on_arrival_();
}

/// Returns false if the server closes or another client replaces the disconnected `client`.
bool StreamServer::wait_for_room(int client) {
  std::unique_lock lock(mutex_);
  while (!closing_ && arrived_.bytes.size() >= unread_maximum) {
    if (room_.wait_for(lock, poll_interval) == std::cv_status::no_timeout) continue;
    pollfd connection{client, POLLRDHUP, 0};
    const bool is_gone = local::repeat_interrupted([&] { return ::poll(&connection, 1, 0); }) > 0;
    if (is_gone && others_wait()) return false;
  }
  return !closing_;
}

bool StreamServer::others_wait() const {
  pollfd connection{listener_.descriptor(), POLLIN, 0};
  return local::repeat_interrupted([&] { return ::poll(&connection, 1, 0); }) > 0;
}

StreamServer::Arrived StreamServer::take() {
  const std::lock_guard lock(mutex_);
  room_.notify_one();
  return std::exchange(arrived_, {});
}

void StreamServer::send(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (client_.is_open() && !bytes.empty() && !local::send_all(client_.number(), bytes))
    ::shutdown(client_.number(), SHUT_RDWR);
}

}  // namespace inkwell::virtual_board
