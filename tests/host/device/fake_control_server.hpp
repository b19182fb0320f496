// A control socket without a board behind it, for tests: what it answers is set by the test.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace inkwell::tests {

class FakeControlServer {
 public:
  /// What it sends for a request, with the end of the line.
  using Answer = std::function<std::string(const nlohmann::json&)>;

  explicit FakeControlServer(Answer answer);
  ~FakeControlServer();

  std::uint16_t port() const { return port_; }
  std::vector<nlohmann::json> requests();
  /// Cuts the connection, as a board that was stopped would.
  void hang_up();

 private:
  void accept_clients();
  void serve(int client);

  Answer answer_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::mutex mutex_;
  int client_ = -1;
  bool stopping_ = false;
  std::vector<nlohmann::json> requests_;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace inkwell::tests
