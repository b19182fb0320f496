#include "tests/host/client/device/fake_control_server.hpp"

#include <sys/socket.h>

namespace inkwell::tests {

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

}  // namespace inkwell::tests
