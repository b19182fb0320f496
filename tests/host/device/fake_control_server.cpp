#include "fake_control_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace inkwell::tests {

FakeControlServer::FakeControlServer(Answer answer) : answer_(std::move(answer)) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(listener_, reinterpret_cast<sockaddr*>(&address), size);
  listen(listener_, 4);
  getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { accept_clients(); });
}

FakeControlServer::~FakeControlServer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (client_ >= 0) shutdown(client_, SHUT_RDWR);
  }
  shutdown(listener_, SHUT_RDWR);
  thread_.join();
  close(listener_);
}

void FakeControlServer::accept_clients() {
  for (;;) {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) return;
    {
      const std::lock_guard lock(mutex_);
      client_ = client;
      if (stopping_) shutdown(client, SHUT_RDWR);
    }
    serve(client);
    const std::lock_guard lock(mutex_);
    close(client);
    client_ = -1;
  }
}

void FakeControlServer::serve(int client) {
  std::string line;
  for (char character; recv(client, &character, 1, 0) == 1;) {
    if (character != '\n') {
      line += character;
      continue;
    }
    const auto request = nlohmann::json::parse(line);
    line.clear();
    {
      const std::lock_guard lock(mutex_);
      requests_.push_back(request);
    }
    const std::string reply = answer_(request);
    for (std::size_t sent = 0; sent < reply.size();) {
      const ssize_t length = ::send(client, reply.data() + sent, reply.size() - sent, MSG_NOSIGNAL);
      if (length <= 0) return;
      sent += static_cast<std::size_t>(length);
    }
  }
}

std::vector<nlohmann::json> FakeControlServer::requests() {
  const std::lock_guard lock(mutex_);
  return requests_;
}

void FakeControlServer::hang_up() {
  const std::lock_guard lock(mutex_);
  if (client_ >= 0) shutdown(client_, SHUT_RDWR);
}

}  // namespace inkwell::tests
