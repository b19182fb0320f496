// Serves one client after another on this computer, for tests.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "host/client/local/listener.hpp"

namespace inkwell::tests {

/// The server must be the last member of its owner, so that the thread stops before the data is destroyed.
class LocalServer {
 public:
  /// `serve(client)` runs in the server's thread and uses the connected socket until it returns.
  explicit LocalServer(std::function<void(int client)> serve, const local::SocketAddress& where = {});
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  const local::SocketAddress& address() const { return listener_.address(); }
  std::uint16_t port() const { return address().port; }
  /// Closes the connection, like a stopped board.
  void hang_up();

 private:
  void accept_clients();

  std::function<void(int)> serve_;
  local::Listener listener_;
  std::mutex mutex_;
  int client_ = -1;
  bool stopping_ = false;
  std::thread thread_;  ///< last member, because the thread uses all other members
};

}  // namespace inkwell::tests
