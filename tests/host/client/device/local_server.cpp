#include "tests/host/client/device/local_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>

namespace inkwell::tests {

LocalServer::LocalServer(std::function<void(int client)> serve, const local::SocketAddress& where)
    : serve_(std::move(serve)), listener_(where, "the test's server") {
  thread_ = std::thread([this] { accept_clients(); });
}

LocalServer::~LocalServer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (client_ >= 0) shutdown(client_, SHUT_RDWR);
  }
  shutdown(listener_.descriptor(), SHUT_RDWR);
  thread_.join();
}

void LocalServer::hang_up() {
  const std::lock_guard lock(mutex_);
  if (client_ >= 0) shutdown(client_, SHUT_RDWR);
}

void LocalServer::accept_clients() {
  for (;;) {
    const int client = accept4(listener_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) return;
    const int yes = 1;
    setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);  // a pose follows an answer immediately
    {
      const std::lock_guard lock(mutex_);
      client_ = client;
      if (stopping_) shutdown(client, SHUT_RDWR);
    }
    serve_(client);
    const std::lock_guard lock(mutex_);
    close(client);
    client_ = -1;
  }
}

}  // namespace inkwell::tests
