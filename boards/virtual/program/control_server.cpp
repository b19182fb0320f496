#include "boards/virtual/program/control_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <string_view>
#include <utility>

#include "host/client/local/interruption.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::size_t line_maximum = 1 << 20;

bool refuse(int socket, std::string_view reason) {
  local::send_all(socket, nlohmann::json{{"ok", false}, {"error", reason}}.dump() + '\n');
  return false;
}

/// Returns true if the line may be a command. A browser request must not be executed.
bool may_be_command(std::string_view line) {
  const auto first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '{';
}

}  // namespace

ControlServer::ControlServer(const local::SocketAddress& where) : listener_(where, "--control") {
  acceptor_ = std::thread([this] { accept_clients(); });
}

ControlServer::~ControlServer() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    requests_.clear();  // destroys their promises, which notifies their clients
    for (Client& client : clients_)
      if (client.socket.is_open()) ::shutdown(client.socket.number(), SHUT_RD);
  }
  ::shutdown(listener_.descriptor(), SHUT_RDWR);
  acceptor_.join();
  for (Client& client : clients_) client.thread.join();
}

void ControlServer::accept_clients() {
  for (;;) {
    local::Descriptor socket(
        local::repeat_interrupted([&] { return ::accept4(listener_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC); }));
    const bool has_failed = !socket.is_open() && errno != ECONNABORTED;
    {
      const std::lock_guard lock(mutex_);
      if (closing_) return;
    }
    if (has_failed) std::this_thread::sleep_for(local::accept_rest);
    if (socket.is_open()) accept(std::move(socket));
  }
}

void ControlServer::accept(local::Descriptor socket) {
  const int on = 1;
  ::setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  const timeval patience{2, 0};  // a client that does not read must not block the program's exit
  ::setsockopt(socket.number(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  const std::lock_guard lock(mutex_);
  if (closing_) return;
  clients_.remove_if([](Client& client) {
    if (client.gone) client.thread.join();
    return client.gone;
  });
  if (clients_.size() >= clients_maximum) {
    std::string reason = "the control socket already serves ";
    reason += std::to_string(clients_maximum);
    reason += " clients, which is the limit; close one client first";
    refuse(socket.number(), reason);
    return;
  }
  Client& client = clients_.emplace_back(Client{std::move(socket), {}});
  client.thread = std::thread([this, &client] { serve(client); });
}

void ControlServer::serve(Client& client) {
  std::array<char, 4096> chunk;
  std::string received;
  for (;;) {
    const ssize_t count =
        local::repeat_interrupted([&] { return ::recv(client.socket.number(), chunk.data(), chunk.size(), 0); });
    if (count <= 0) break;
    received.append(chunk.data(), static_cast<std::size_t>(count));
    if (!serve_lines(client.socket.number(), received)) break;
  }
  ::shutdown(client.socket.number(), SHUT_RDWR);
  const std::lock_guard lock(mutex_);
  client.socket = local::Descriptor();  // closed now and not at the next connection, because the system limits the
                                        // number of descriptors
  client.gone = true;
}

bool ControlServer::serve_lines(int socket, std::string& received) {
  std::size_t begin = 0;
  for (std::size_t end; (end = received.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = received.substr(begin, end - begin);
    if (!may_be_command(line)) break;
    const auto reply = ask(line);
    // An error message may quote bytes that are not valid UTF-8.
    constexpr auto replace = nlohmann::json::error_handler_t::replace;
    if (!reply || !local::send_all(socket, reply->dump(-1, ' ', false, replace) + '\n')) return false;
  }
  received.erase(0, begin);
  if (!may_be_command(received))
    return refuse(socket, "a command is one JSON object in one line, such as {\"command\":\"status\"}");
  if (received.size() > line_maximum) return refuse(socket, "the line is too long; end each command with a newline");
  return true;
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
    return nlohmann::json{{"ok", false}, {"error", "the virtual board exited before it replied"}};
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
