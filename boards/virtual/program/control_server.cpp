#include "control_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <utility>

#include "loopback.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::size_t line_maximum = 1 << 20;

}  // namespace

ControlServer::ControlServer(std::uint16_t port) : listener_(listen_on_loopback(port, "--control")), port_(port) {
  acceptor_ = std::thread([this] { accept_clients(); });
}

ControlServer::~ControlServer() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    requests_.clear();  // breaks their promises, which their clients are told
    for (Client& client : clients_) ::shutdown(client.socket, SHUT_RD);
  }
  ::shutdown(listener_, SHUT_RDWR);
  acceptor_.join();
  for (Client& client : clients_) {
    client.thread.join();
    ::close(client.socket);
  }
  ::close(listener_);
}

void ControlServer::accept_clients() {
  for (;;) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) {
      if (errno == EINTR || errno == ECONNABORTED) continue;
      const std::lock_guard lock(mutex_);
      if (closing_) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // out of descriptors: clients may leave
      continue;
    }
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const timeval patience{2, 0};  // a client that does not read must not keep the program from ending
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    const std::lock_guard lock(mutex_);
    for (auto client = clients_.begin(); client != clients_.end();) {
      if (client->gone) {
        client->thread.join();
        ::close(client->socket);
        client = clients_.erase(client);
      } else {
        ++client;
      }
    }
    if (closing_) {
      ::close(socket);
      return;
    }
    Client& client = clients_.emplace_back(Client{socket, {}});
    client.thread = std::thread([this, &client] { serve(client); });
  }
}

void ControlServer::serve(Client& client) {
  std::array<char, 4096> chunk;
  std::string pending;
  bool open = true;
  while (open) {
    const ssize_t received = ::recv(client.socket, chunk.data(), chunk.size(), 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) break;
    pending.append(chunk.data(), static_cast<std::size_t>(received));
    std::size_t begin = 0;
    for (std::size_t end; open && (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1) {
      const auto reply = ask(pending.substr(begin, end - begin));
      // An error may quote bytes of the client that are no UTF-8.
      constexpr auto replace = nlohmann::json::error_handler_t::replace;
      open = reply && send_all(client.socket, reply->dump(-1, ' ', false, replace) + '\n');
    }
    pending.erase(0, begin);
    if (pending.size() > line_maximum) {
      send_all(client.socket, R"({"ok":false,"error":"the line is too long; a command ends with a newline"})"
                              "\n");
      break;
    }
  }
  ::shutdown(client.socket, SHUT_RDWR);
  const std::lock_guard lock(mutex_);
  client.gone = true;
}

std::optional<nlohmann::json> ControlServer::ask(std::string line) {
  std::future<nlohmann::json> reply;
  {
    const std::lock_guard lock(mutex_);
    if (closing_) return std::nullopt;
    requests_.push_back({std::move(line), {}});
    reply = requests_.back().reply.get_future();
  }
  arrived_.notify_one();
  try {
    return reply.get();
  } catch (const std::future_error&) {
    return nlohmann::json{{"ok", false}, {"error", "the virtual board ended before it could answer"}};
  }
}

std::optional<ControlRequest> ControlServer::take(std::chrono::steady_clock::time_point give_up) {
  std::unique_lock lock(mutex_);
  arrived_.wait_until(lock, give_up, [this] { return !requests_.empty() || woken_; });
  woken_ = false;
  if (requests_.empty()) return std::nullopt;
  ControlRequest request = std::move(requests_.front());
  requests_.pop_front();
  return request;
}

void ControlServer::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  arrived_.notify_one();
}

}  // namespace inkwell::virtual_board
