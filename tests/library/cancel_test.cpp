// Tests the cancellation of threads that wait in the library.
#include <doctest/doctest.h>

#include <atomic>
#include <string>

#include <inkwell/inkwell.hpp>
#include "tests/cancelled_thread.hpp"
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

/// A wait of this duration never finishes during the test.
constexpr double long_s = 1000;

TEST_CASE("a thread that is cancelled in a call that waits ends there, and the arm goes on") {
  Board board({.paused = true});
  VirtualArm virtual_arm(board.address);
  inkwell_arm* const arm = virtual_arm.arm;
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_UNREFERENCED; });
  const char* const name = "supply_V";
  REQUIRE(inkwell_select_signals(arm, &name, 1) == INKWELL_OK);
  struct Gate {
    std::atomic<bool> is_in = false, may_go = false;
  } gate;
  const auto hangs = [](inkwell_arm*, const inkwell_pose*, double*, void* user) {
    auto& self = *static_cast<Gate*>(user);
    self.is_in = true;
    self.is_in.notify_all();
    self.may_go.wait(false);
    return 1;
  };
  REQUIRE(inkwell_start_servo(arm, hangs, &gate) == INKWELL_OK);
  gate.is_in.wait(false);

  CHECK(CancelledThread([&] { inkwell_enable_force(arm, long_s); }).ends_when_cancelled());
  CHECK(CancelledThread([&] { inkwell_stop_servo(arm); }).ends_when_cancelled());
  CHECK(CancelledThread([&] {
          inkwell_pose pose;
          while (inkwell_wait_for_pose(arm, long_s, &pose) == INKWELL_OK) continue;
        }).ends_when_cancelled());
  CHECK(CancelledThread([&] {
          inkwell::Vector values;  // an object with a destructor
          std::string address(100, 'x');
          inkwell_pose pose;
          while (inkwell_wait_for_pose(arm, long_s, &pose) == INKWELL_OK) values[0] += address.size();
        }).ends_when_cancelled());
  board.control.pause();
  CHECK(CancelledThread([&] {
          float value = 0;
          std::size_t count = 0;
          while (inkwell_read_scope(arm, long_s, &value, nullptr, 1, &count, nullptr) == INKWELL_OK) continue;
        }).ends_when_cancelled());
  board.control.resume();

  // A call that frees memory is completed before the cancellation.
  inkwell_arm* second = nullptr;
  REQUIRE(inkwell_open(board.address.c_str(), &second) == INKWELL_OK);
  std::atomic<int> closed = -1;
  CancelledThread([&] { closed = inkwell_close(second); }).ends_when_cancelled();
  CHECK(closed == INKWELL_OK);
  second = nullptr;
  CancelledThread([&] { inkwell_open(board.address.c_str(), &second); }).ends_when_cancelled();
  CHECK(second != nullptr);
  CHECK(inkwell_close(second) == INKWELL_OK);

  gate.may_go = true;
  gate.may_go.notify_all();
  CHECK(inkwell_stop_servo(arm) == INKWELL_OK);
  board.control.dock(true);
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  float value = 0;
  std::size_t count = 0;
  CHECK(inkwell_read_scope(arm, 60, &value, nullptr, 1, &count, nullptr) == INKWELL_OK);
}

}  // namespace
}  // namespace inkwell::tests
