// Tests the state of the parent's mutexes and descriptors in a forked child.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <thread>

#include "host/client/process/fork.hpp"

namespace inkwell::tests {
namespace {

std::mutex fork_test_mutex;
std::recursive_mutex fork_test_recursive_mutex;
const process::HeldAtFork fork_test_held(fork_test_mutex), fork_test_recursive_held(fork_test_recursive_mutex);

bool in_child(const std::function<bool()>& condition) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    _exit(condition() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_CASE("a child finds a mutex free that other threads take all the time, and so does its parent afterwards") {
  std::atomic<bool> ends = false;
  int one = 0, other = 0;
  std::jthread works([&] {
    while (!ends) {
      const std::lock_guard lock(fork_test_mutex);
      ++one;
      ++other;
    }
  });
  std::jthread works_too([&] {
    while (!ends) {
      const std::lock_guard lock(fork_test_recursive_mutex);
      const std::lock_guard again(fork_test_recursive_mutex);
    }
  });
  for (int i = 0; i < 50; ++i)
    CHECK(in_child([&] {
      const std::lock_guard lock(fork_test_mutex);
      const std::lock_guard lock_too(fork_test_recursive_mutex);
      return one == other;
    }));
  ends = true;
  works.join();
  works_too.join();
  CHECK(fork_test_mutex.try_lock());
  fork_test_mutex.unlock();
  CHECK(fork_test_recursive_mutex.try_lock());
  fork_test_recursive_mutex.unlock();
}

TEST_CASE("in a child the parent's descriptor leads nowhere, and the parent keeps it") {
  int ends[2];
  REQUIRE(pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0);
  char byte = 'x';
  {
    process::OwnDescriptor own(ends[1]);
    process::OwnDescriptor moved = std::move(own);
    CHECK(in_child([&] { return write(ends[1], &byte, 1) == 1; }));
    CHECK(read(ends[0], &byte, 1) == -1);
    CHECK(write(ends[1], &byte, 1) == 1);
    CHECK(read(ends[0], &byte, 1) == 1);
  }
  CHECK(in_child([&] { return write(ends[1], &byte, 1) == 1; }));  // the descriptor has no owner any more
  CHECK(read(ends[0], &byte, 1) == 1);
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("Origin::is_here returns false in a forked child process") {
  const process::Origin origin;
  CHECK(origin.is_here());
  CHECK(origin.process() == getpid());
  CHECK(in_child([&] { return !origin.is_here() && origin.process() == getppid(); }));
}

}  // namespace
}  // namespace inkwell::tests
