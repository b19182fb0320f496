// Server for the control socket. The server passes JSON lines from clients to the simulation thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <future>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>
#include "host/client/local/listener.hpp"

namespace inkwell::virtual_board {

/// One command line of a client. The client waits until `reply` is set.
struct ControlRequest {
  std::string line;
  std::promise<nlohmann::json> reply;
};

class ControlServer {
 public:
  /// Largest number of clients. Further clients are refused with an error sentence.
  static constexpr std::size_t clients_maximum = 32;

  /// @throws std::runtime_error if the server cannot listen. The error sentence names --control.
  explicit ControlServer(const local::SocketAddress& where);
  /// Answers pending requests, disconnects all clients and joins their threads.
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  const local::SocketAddress& address() const { return listener_.address(); }
  /// Returns the oldest request. Waits for a request until the time `give_up` or a call of wake().
  std::optional<ControlRequest> take(std::chrono::steady_clock::time_point give_up);
  /// Ends the present or the next wait of take(). May be called from any thread.
  void wake();

 private:
  struct Client {
    local::Descriptor socket;
    std::thread thread;
    bool gone = false;  ///< its thread has ended and can be joined
  };
  void accept_clients();
  void accept(local::Descriptor socket);
  void serve(Client& client);
  /// Returns false if the client must be disconnected.
  bool serve_lines(int socket, std::string& received);
  std::optional<nlohmann::json> ask(std::string line);

  local::Listener listener_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<ControlRequest> requests_;
  std::list<Client> clients_;
  bool closing_ = false;
  bool woken_ = false;
  std::thread acceptor_;
};

}  // namespace inkwell::virtual_board
