// A control socket without a board behind it, for tests: what it answers is set by the test.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "local_server.hpp"

namespace inkwell::tests {

class FakeControlServer {
 public:
  /// What it sends for a request, with the end of the line.
  using Answer = std::function<std::string(const nlohmann::json&)>;

  explicit FakeControlServer(Answer answer) : answer_(std::move(answer)) {}

  std::uint16_t port() const { return server_.port(); }
  std::vector<nlohmann::json> requests();
  /// Cuts the connection, as a board that was stopped would.
  void hang_up() { server_.hang_up(); }

 private:
  void serve(int client);

  Answer answer_;
  std::mutex mutex_;
  std::vector<nlohmann::json> requests_;
  LocalServer server_{[this](int client) { serve(client); }};
};

}  // namespace inkwell::tests
