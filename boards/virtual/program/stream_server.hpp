// Server for GDB or a UART terminal. The server accepts one client at a time.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "host/client/local/listener.hpp"

#include "boards/virtual/program/byte_stream.hpp"

namespace inkwell::virtual_board {

/// Returns true if a client's first bytes may belong to the expected protocol.
using FirstBytes = bool (*)(std::string_view bytes);
/// Returns true if the first byte is Ctrl-C or may start an acknowledgment or a GDB packet.
bool may_be_gdb(std::string_view bytes);
/// Returns false if the first bytes belong to a browser request (HTTP or TLS).
bool may_be_terminal(std::string_view bytes);

class StreamServer final : public ByteStream {
 public:
  /// A client is disconnected if `welcome` rejects its first bytes. Until the first bytes arrive, the client is not
  /// reported as connected. The server thread calls `on_arrival` when take() has data.
  /// @throws std::runtime_error if the server cannot listen. The error sentence names `option`.
  StreamServer(const local::SocketAddress& where, std::string_view option, FirstBytes welcome,
               std::function<void()> on_arrival);
  ~StreamServer() override;
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  const local::SocketAddress& address() const { return listener_.address(); }
  Arrived take() override;
  void send(std::string_view bytes) override;

 private:
  void serve();
  void receive_from(int client);
  bool wait_for_room(int client);
  bool others_wait() const;

  local::Listener listener_;
  FirstBytes welcome_;
  std::function<void()> on_arrival_;
  std::mutex mutex_;
  std::condition_variable room_;
  local::Descriptor client_;
  bool closing_ = false;
  Arrived arrived_;
  std::thread thread_;
};

}  // namespace inkwell::virtual_board
