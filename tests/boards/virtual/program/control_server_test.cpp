// Tests which clients the control socket's server accepts and refuses, without a board.
#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <list>
#include <string>
#include <thread>

#include "boards/virtual/program/control_server.hpp"
#include "tests/plain_client.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::virtual_board;
using inkwell::tests::PlainClient;
using nlohmann::json;
using namespace std::chrono_literals;

namespace {

/// The server counts its requests and answers them in a separate thread.
class AnsweringServer {
 public:
  explicit AnsweringServer(const local::SocketAddress& where = {}) : server_(where) {
    thread_ = std::thread([this] {
      while (!ends_)
        if (auto request = server_.take(std::chrono::steady_clock::now() + 10s))
          request->reply.set_value({{"ok", true}, {"request", ++requests_}});
    });
  }
  ~AnsweringServer() {
    ends_ = true;
    server_.wake();
    thread_.join();
  }
  const local::SocketAddress& address() const { return server_.address(); }
  int requests() const { return requests_; }

 private:
  ControlServer server_;
  std::atomic<bool> ends_ = false;
  std::atomic<int> requests_ = 0;
  std::thread thread_;
};

bool is_served(PlainClient& client) {
  return client.send("{\"command\":\"status\"}\n") && json::parse(client.line()).at("ok") == true;
}

std::ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

}  // namespace

TEST_SUITE("virtual board: control socket") {
  TEST_CASE("a client of another protocol gets an error and is disconnected, and none of its bytes has an effect") {
    AnsweringServer server;
    const std::string command = "{\"command\":\"buttons\",\"pressed\":[true,true]}\n";
    for (const auto& begin : {std::string("GET / HTTP/1.1\r\n\r\n"), std::string("POST / HTTP/1.1\r\n\r\n"),
                              std::string("P"), std::string("\x16\x03\x01"), std::string("[]")}) {
      CAPTURE(begin);
      PlainClient client(server.address());
      client.send(begin);
      if (begin.size() > 4) client.send(command);
      CHECK(json::parse(client.line()).at("ok") == false);
      CHECK(client.is_closed());
    }
    CHECK(server.requests() == 0);
    PlainClient own(server.address());
    CHECK(is_served(own));
    own.send(command + "GET /\n" + command);
    CHECK(json::parse(own.line()).at("ok") == true);
    CHECK(json::parse(own.line()).at("ok") == false);
    CHECK(own.is_closed());
    CHECK(server.requests() == 2);
  }

  TEST_CASE("one client too many is refused with a sentence until another client disconnects") {
    AnsweringServer server;
    std::list<PlainClient> clients;
    while (clients.size() < ControlServer::clients_maximum) {
      clients.emplace_back(server.address());
      REQUIRE(is_served(clients.back()));
    }
    PlainClient refused(server.address());
    CHECK(json::parse(refused.line()).at("error").get<std::string>().find("32 clients") != std::string::npos);
    CHECK(refused.is_closed());
    clients.pop_front();
    bool is_accepted = false;
    for (int tries = 0; !is_accepted && tries < 10'000; ++tries) {
      PlainClient next(server.address());
      next.send("{}\n");
      is_accepted = json::parse(next.line()).at("ok") == true;
    }
    CHECK(is_accepted);
  }

  TEST_CASE("the file of a disconnected client is closed without another client") {
    AnsweringServer server;
    const auto before = open_files();
    {
      std::list<PlainClient> clients;
      for (int i = 0; i < 20; ++i) {
        clients.emplace_back(server.address());
        REQUIRE(is_served(clients.back()));
      }
    }
    for (int tries = 0; open_files() != before && tries < 10'000; ++tries) std::this_thread::sleep_for(1ms);
    CHECK(open_files() == before);
  }

  TEST_CASE("clients that cannot be accepted for want of files do not hold up the board") {
    ControlServer server{{}};
    local::Descriptor next(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(server.address().port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    const rlimit lowest{3, limit.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &lowest);
    const bool is_connected =
        ::connect(next.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    // If the server waited with a locked mutex, only one call per 20 ms would be possible.
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    int calls = 0;
    for (; calls < 20'000 && std::chrono::steady_clock::now() < deadline; ++calls)
      server.take(std::chrono::steady_clock::time_point::min());
    ::setrlimit(RLIMIT_NOFILE, &limit);
    CHECK(is_connected);
    CHECK(calls == 20'000);
  }

  TEST_CASE("over a Unix socket") {
    const tests::TemporaryDirectory directory;
    {
      AnsweringServer server({.path = directory / "control"});
      PlainClient client(server.address());
      CHECK(is_served(client));
    }
    CHECK(std::filesystem::is_empty(directory.path()));
  }
}
