// Tests what a real-time program needs: thread priorities, and calls that allocate no memory.
#include <doctest/doctest.h>

#include <sched.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <thread>

#include <inkwell/inkwell.h>
#include "tests/dropins/board.hpp"

#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/seen_poses.hpp"
#include "tests/library/virtual_arm.hpp"

namespace {
/// Memory allocations of this thread. The library calls the operators of the program.
thread_local std::uint64_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace inkwell::tests {
namespace {

void let_pass_ms(int time_ms) { std::this_thread::sleep_for(std::chrono::milliseconds(time_ms)); }

/// Number of this process's threads with SCHED_FIFO and this priority.
int threads_with(int priority) {
  int found = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    const pid_t thread = std::stoi(task.path().filename());
    sched_param parameters{};
    if (sched_getparam(thread, &parameters) != 0) continue;  // the thread has exited
    const bool is_fifo = (sched_getscheduler(thread) & ~SCHED_RESET_ON_FORK) == SCHED_FIFO;
    if (is_fifo && parameters.sched_priority == priority) ++found;
  }
  return found;
}

bool may_set_priorities() {
  bool may = false;
  std::thread([&] {
    const sched_param parameters{.sched_priority = 1};
    may = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
  }).join();
  return may;
}

TEST_CASE("the threads of an arm get a real-time priority, or the user learns how to permit it") {
  VirtualArm virtual_arm;
  CHECK(inkwell_set_thread_priority(virtual_arm.arm, -1) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_set_thread_priority(virtual_arm.arm, 100) == INKWELL_BAD_ARGUMENT);
  CHECK(says("1 to 99"));
  const auto result = inkwell_set_thread_priority(virtual_arm.arm, 37);
  if (!may_set_priorities()) {
    CHECK(result == INKWELL_NO_PERMISSION);
    CHECK(says("/etc/security/limits.d"));
    return;
  }
  REQUIRE_MESSAGE(result == INKWELL_OK, std::string(inkwell_error_text()));
  CHECK(threads_with(37) == 2);  // the threads of poses and servo; in lock step the pose thread sends the forces
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  REQUIRE(inkwell_set_thread_priority(virtual_arm.arm, 0) == INKWELL_OK);
  CHECK(threads_with(37) == 0);
}

/// Scheduling priority in the kernel's notation, where SCHED_FIFO 1 to 99 is -2 to -100.
int kernel_priority(pid_t thread) {
  std::ifstream stat("/proc/self/task/" + std::to_string(thread) + "/stat");
  std::string text;
  std::getline(stat, text);
  text.erase(0, text.rfind(')') + 2);
  for (int i = 0; i < 15; ++i) text.erase(0, text.find(' ') + 1);
  return std::stoi(text);
}

TEST_CASE("a thread that owns a mutex of the poses inherits the priority of a waiting thread") {
  if (!may_set_priorities()) return;
  library::PoseFeed poses;
  std::atomic<pid_t> owner = 0;
  std::atomic<bool> is_done = false;
  std::thread ordinary([&] {
    poses.read([&](const auto&) {
      owner = gettid();
      while (!is_done) let_pass_ms(1);
    });
  });
  while (owner == 0) let_pass_ms(1);
  CHECK(kernel_priority(owner) >= 0);
  std::thread urgent([&] {
    const sched_param parameters{.sched_priority = 40};
    sched_setscheduler(0, SCHED_FIFO, &parameters);
    static_cast<void>(poses.last());
  });
  for (int i = 0; i < 10'000 && kernel_priority(owner) >= 0; ++i) let_pass_ms(1);
  CHECK(kernel_priority(owner) == -41);
  is_done = true;
  ordinary.join();
  urgent.join();
}

/// Allocations of 100 calls.
std::uint64_t allocations_of(const std::function<void()>& call) {
  const std::uint64_t before = allocations;
  for (int i = 0; i < 100; ++i) call();
  return allocations - before;
}

TEST_CASE("states, poses and forces allocate no memory, even while the cable is unplugged or the force is lost") {
  Board board;
  VirtualArm driver(board.address);
  driver.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  REQUIRE(inkwell_claim(driver.arm) == INKWELL_OK);
  const double none_N[3]{};
  inkwell_arm_state state;
  inkwell_pose pose;
  std::array<inkwell_result, 4> results{};
  const auto loop = [&] {
    results = {inkwell_get_state(driver.arm, &state, sizeof state), inkwell_get_pose(driver.arm, &pose),
               inkwell_set_force(driver.arm, none_N), inkwell_set_joint_torques(driver.arm, none_N)};
  };
  loop();
  CHECK(allocations_of([] { delete new int; }) == 100);  // the counter works
  CHECK(allocations_of(loop) == 0);
  CHECK(results == std::array{INKWELL_OK, INKWELL_OK, INKWELL_OK, INKWELL_OK});

  board.control.usb(false);
  while (inkwell_get_pose(driver.arm, &pose) == INKWELL_OK) let_pass_ms(5);
  CHECK(allocations_of(loop) == 0);
  CHECK(results == std::array{INKWELL_DISCONNECTED, INKWELL_DISCONNECTED, INKWELL_DISCONNECTED, INKWELL_DISCONNECTED});
  CHECK(says("unplugged"));
  CHECK(state.is_referenced == 1);
}

TEST_CASE("the answers of a loop are noted without memory") {
  library::SeenPoses seen;
  seen.note(1);
  CHECK(allocations_of([&] {
          seen.note_force();
          seen.take_force();
          seen.note(2);
        }) == 0);
}

}  // namespace
}  // namespace inkwell::tests
