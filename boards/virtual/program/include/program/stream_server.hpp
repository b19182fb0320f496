// Where GDB, or a terminal for a UART, connects: one at a time.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include <local/listener.hpp>

#include <program/byte_stream.hpp>

namespace inkwell::virtual_board {

/// Whether the first bytes that a client sends may be of the expected protocol.
using FirstBytes = bool (*)(std::string_view bytes);
/// GDB begins with an acknowledgement, a packet or Ctrl-C.
bool may_be_gdb(std::string_view bytes);
/// A UART carries any bytes, but a browser's requests are not meant for it: HTTP, or the begin of TLS.
bool may_be_terminal(std::string_view bytes);

class StreamServer final : public ByteStream {
 public:
  /// A client is disconnected if its first bytes are not `welcome`; until they come it is not reported as connected.
  /// `on_arrival` is called from another thread when there is something to take.
  /// @throws std::runtime_error with a sentence that names `option` if it cannot listen there.
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
