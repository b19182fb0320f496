// Where GDB connects: one at a time, on 127.0.0.1. Its bytes wait here for the simulation's thread.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace inkwell::virtual_board {

class GdbServer {
 public:
  /// `on_arrival` is called from another thread when there is something to take.
  /// @throws std::runtime_error with a sentence if the port cannot be had.
  GdbServer(std::uint16_t port, std::function<void()> on_arrival);
  ~GdbServer();
  GdbServer(const GdbServer&) = delete;
  GdbServer& operator=(const GdbServer&) = delete;

  std::uint16_t port() const { return port_; }
  struct Arrived {
    bool connected = false, gone = false;  ///< since the last call; a GDB that came and went is both
    std::string bytes;
  };
  Arrived take();
  void send(std::string_view bytes);

 private:
  void serve();

  std::uint16_t port_;
  int listener_;
  std::function<void()> on_arrival_;
  std::mutex mutex_;
  int client_ = -1;
  bool closing_ = false;
  Arrived arrived_;
  std::thread thread_;
};

}  // namespace inkwell::virtual_board
