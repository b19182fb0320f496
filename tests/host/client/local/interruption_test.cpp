// Tests that signals of a profiler or a timer do not disturb system calls.
#include <doctest/doctest.h>

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "host/client/device/socket.hpp"
#include "host/client/local/descriptor.hpp"
#include "host/client/local/interruption.hpp"

using namespace inkwell;

namespace {

/// Sends SIGALRM to this process every 0.3 ms. System calls are interrupted.
class SignalTimer {
 public:
  SignalTimer() {
    struct sigaction action {};
    action.sa_handler = [](int) {};
    sigaction(SIGALRM, &action, &before_);
    const itimerval period{{0, 300}, {0, 300}};
    setitimer(ITIMER_REAL, &period, nullptr);
  }
  ~SignalTimer() {
    const itimerval none{};
    setitimer(ITIMER_REAL, &none, nullptr);
    sigaction(SIGALRM, &before_, nullptr);
  }

 private:
  struct sigaction before_ {};
};

}  // namespace

TEST_CASE("an interrupted call is repeated until it succeeds or fails for another reason") {
  int calls = 0;
  const auto interrupted_twice = [&](int result, int reason) {
    return local::repeat_interrupted([&, result, reason] {
      errno = ++calls < 3 ? EINTR : reason;
      return calls < 3 ? -1 : result;
    });
  };
  CHECK(interrupted_twice(7, 0) == 7);
  CHECK(calls == 3);
  calls = 0;
  CHECK(interrupted_twice(-1, EPIPE) == -1);
  CHECK(calls == 3);
  errno = EINTR;  // of an earlier call
  CHECK(local::repeat_interrupted([] { return -1; }) == -1);
}

TEST_CASE("an interrupted call with a time limit does not exceed the limit") {
  using namespace std::chrono_literals;
  std::vector<std::chrono::milliseconds> rests;
  local::repeat_interrupted(20ms, [&](std::chrono::milliseconds rest) {
    rests.push_back(rest);
    std::this_thread::sleep_for(15ms);
    errno = EINTR;
    return rests.size() < 4 ? -1 : 0;
  });
  REQUIRE(rests.size() == 4);
  CHECK(rests[0] <= 20ms);
  CHECK(rests[1] <= 5ms);
  CHECK(rests[2] == 0ms);
  CHECK(rests[3] == 0ms);
}

TEST_CASE("a signal during a connection attempt does not disturb the connection") {
  const local::Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof name;
  REQUIRE(bind(listener.number(), reinterpret_cast<sockaddr*>(&name), size) == 0);
  REQUIRE(listen(listener.number(), 0) == 0);
  getsockname(listener.number(), reinterpret_cast<sockaddr*>(&name), &size);
  const device::SocketAddress server{.host = "127.0.0.1", .port = ntohs(name.sin_port)};
  const device::Socket first(server);  // fills the queue, so that the next attempt takes about a second
  std::thread acceptor([&] {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, nullptr);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    for (int i = 0; i < 2; ++i) close(accept(listener.number(), nullptr, nullptr));
  });
  {
    const SignalTimer timer;
    CHECK_NOTHROW(device::Socket second(server));
  }
  acceptor.join();
}
