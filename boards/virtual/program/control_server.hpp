// The control socket: lines of JSON from any number of clients, handed to the simulation's thread one by one.
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

namespace inkwell::virtual_board {

/// One line of a client. The client waits until `reply` is set.
struct ControlRequest {
  std::string line;
  std::promise<nlohmann::json> reply;
};

class ControlServer {
 public:
  /// Listens on 127.0.0.1; port 0 is any free one.
  /// @throws std::runtime_error with a sentence if the port cannot be had.
  explicit ControlServer(std::uint16_t port);
  /// Answers what was asked, hangs up on all clients and joins their threads.
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  std::uint16_t port() const { return port_; }
  /// The oldest request, waiting for one at most until `give_up` or until `wake` was called.
  std::optional<ControlRequest> take(std::chrono::steady_clock::time_point give_up);
  /// Ends a `take` that waits, or the next one. From any thread.
  void wake();

 private:
  struct Client {
    int socket;
    std::thread thread;
    bool gone = false;  ///< its thread has ended and can be joined
  };
  void accept_clients();
  void serve(Client& client);
  std::optional<nlohmann::json> ask(std::string line);

  int listener_;
  std::uint16_t port_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<ControlRequest> requests_;
  std::list<Client> clients_;
  bool closing_ = false;
  bool woken_ = false;
  std::thread acceptor_;
};

}  // namespace inkwell::virtual_board
