// Tests the servers for GDB and UARTs without a board: forwarded bytes and buffer limits.
#include <doctest/doctest.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "boards/virtual/program/stream_server.hpp"
#include "tests/plain_client.hpp"

using namespace inkwell;
using namespace inkwell::virtual_board;
using inkwell::tests::PlainClient;
using namespace std::chrono_literals;

namespace {

class Receiver {
 public:
  explicit Receiver(FirstBytes welcome)
      : server_({}, "--test", welcome, [this] {
          const std::lock_guard lock(mutex_);
          ++news_;
          changed_.notify_one();
        }) {}
  const local::SocketAddress& address() const { return server_.address(); }

  /// Receives until the condition is true; returns false after one minute.
  template <class Condition>
  bool take_until(Condition holds) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (!holds() && std::chrono::steady_clock::now() < deadline) {
      const auto arrived = server_.take();
      was_connected = was_connected || arrived.connected;
      bytes += arrived.bytes;
      largest = std::max(largest, arrived.bytes.size());
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, 10ms, [this] { return news_ > 0; });
      news_ = 0;
    }
    return holds();
  }

  void send(const std::string& text) { server_.send(text); }

  bool was_connected = false;
  std::string bytes;
  std::size_t largest = 0;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int news_ = 0;
  StreamServer server_;
};

}  // namespace

TEST_SUITE("virtual board: streams") {
  TEST_CASE("GDB's protocol begins with an acknowledgement, a packet or Ctrl-C, and nothing else does") {
    for (const char* begin : {"+", "+$qSupported#37", "$g#67", "-", "\x03"}) CHECK(may_be_gdb(begin));
    for (const char* begin : {"GET / HTTP/1.1", "POST /", "\x16\x03\x01", "{", "\n"}) CHECK_FALSE(may_be_gdb(begin));
  }

  TEST_CASE("may_be_terminal refuses only the start of an HTTP or TLS connection") {
    for (const char* begin : {"", "G", "GET\r", "get /", "P", "hello", "\x16"}) CHECK(may_be_terminal(begin));
    for (const char* begin : {"GET / HTTP/1.1", "POST / HTTP/1.1", "OPTIONS * HTTP/1.1", "\x16\x03\x01\x02"})
      CHECK_FALSE(may_be_terminal(begin));
  }

  TEST_CASE("a client with wrong first bytes is disconnected without a report, and the next client is served") {
    Receiver receiver(&may_be_gdb);
    for (const char* begin : {"GET / HTTP/1.1\r\n\r\n$M20000000,4:00000000#88", "P"}) {
      PlainClient stranger(receiver.address());
      stranger.send(begin);
      CHECK(stranger.is_closed());
    }
    PlainClient gdb(receiver.address());
    gdb.send("+$g#67");
    CHECK(receiver.take_until([&] { return receiver.bytes.size() >= 6; }));
    CHECK(receiver.was_connected);
    CHECK(receiver.bytes == "+$g#67");
  }

  TEST_CASE("a client that sends nothing is not reported as connected, but receives the data") {
    Receiver receiver(&may_be_gdb);
    PlainClient silent(receiver.address());
    int looks = 0;
    receiver.take_until([&] { return ++looks > 20; });
    CHECK_FALSE(receiver.was_connected);
    receiver.send("heard all the same");
    CHECK(silent.receive(5) == "heard");
  }

  TEST_CASE("unread bytes wait at the client, complete and in order") {
    Receiver receiver(&may_be_terminal);
    PlainClient client(receiver.address());
    std::string sent;
    while (sent.size() < 20 * ByteStream::unread_maximum) sent += std::to_string(sent.size()) + ' ';
    std::thread sender([&] { client.send(sent); });
    std::this_thread::sleep_for(50ms);
    CHECK(receiver.take_until([&] { return receiver.bytes.size() >= sent.size(); }));
    sender.join();
    CHECK(receiver.bytes == sent);
    CHECK(receiver.largest <= ByteStream::unread_maximum + 4096);
  }

  TEST_CASE("a disconnected client with unread bytes makes room for the next one") {
    Receiver receiver(&may_be_terminal);
    {
      PlainClient gone(receiver.address());
      gone.send(std::string(2 * ByteStream::unread_maximum, 'x'));
    }
    PlainClient next(receiver.address());
    pollfd heard{next.descriptor(), POLLIN, 0};
    for (int tries = 0; heard.revents == 0 && tries < 6000; ++tries) {
      receiver.send("x");
      ::poll(&heard, 1, 10);
    }
    CHECK(heard.revents != 0);
    next.send("next");
    CHECK(receiver.take_until([&] { return receiver.bytes.ends_with("next"); }));
  }
}
