// A control socket without a board, for tests. The test sets the answers.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/host/client/device/local_server.hpp"

namespace inkwell::tests {

class FakeControlServer {
 public:
  /// Answer to a request, including the line end.
  using Answer = std::function<std::string(const nlohmann::json&)>;

  explicit FakeControlServer(Answer answer) : answer_(std::move(answer)) {}

  std::uint16_t port() const { return server_.port(); }
  std::vector<nlohmann::json> requests();
  /// Closes the connection, like a stopped board.
  void hang_up() { server_.hang_up(); }

 private:
  void serve(int client);

  Answer answer_;
  std::mutex mutex_;
  std::vector<nlohmann::json> requests_;
  LocalServer server_{[this](int client) { serve(client); }};
};

}  // namespace inkwell::tests
