// Where GDB, or a terminal for a UART, connects: one at a time, on 127.0.0.1.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "byte_stream.hpp"

namespace inkwell::virtual_board {

class StreamServer final : public ByteStream {
 public:
  /// `on_arrival` is called from another thread when there is something to take.
  /// @throws std::runtime_error with a sentence that names `option` if the port cannot be had.
  StreamServer(std::uint16_t port, std::string_view option, std::function<void()> on_arrival);
  ~StreamServer() override;
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  std::uint16_t port() const { return port_; }
  Arrived take() override;
  void send(std::string_view bytes) override;

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
