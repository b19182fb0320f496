// Listens on this computer for tests, and serves one client after another.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace inkwell::tests {

/// Make it the last member of what it serves from: its thread ends with it.
class LocalServer {
 public:
  /// `serve(client)` has the connected socket until it returns, in the server's thread.
  explicit LocalServer(std::function<void(int client)> serve);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  std::uint16_t port() const { return port_; }
  /// Cuts the connection, as a board that was stopped would.
  void hang_up();

 private:
  void accept_clients();

  std::function<void(int)> serve_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::mutex mutex_;
  int client_ = -1;
  bool stopping_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace inkwell::tests
