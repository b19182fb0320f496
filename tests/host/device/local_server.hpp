// Listens on this computer for tests, and serves one client after another.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include <local/listener.hpp>

namespace inkwell::tests {

/// Make it the last member of what it serves from: its thread ends with it.
class LocalServer {
 public:
  /// `serve(client)` has the connected socket until it returns, in the server's thread.
  explicit LocalServer(std::function<void(int client)> serve, const local::SocketAddress& where = {});
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  const local::SocketAddress& address() const { return listener_.address(); }
  std::uint16_t port() const { return address().port; }
  /// Cuts the connection, as a board that was stopped would.
  void hang_up();

 private:
  void accept_clients();

  std::function<void(int)> serve_;
  local::Listener listener_;
  std::mutex mutex_;
  int client_ = -1;
  bool stopping_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace inkwell::tests
