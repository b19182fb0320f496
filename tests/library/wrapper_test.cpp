// Tests the C++ wrapper: moving, assigning and destroying an arm while its servo runs.
#include <doctest/doctest.h>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include <inkwell/inkwell.hpp>
#include "tests/dropins/board.hpp"

namespace inkwell::tests {
namespace {

constexpr std::uint32_t poses = 20;

void let_pass(const Arm& arm) {
  const auto begin = arm.wait_for_pose().sequence;
  while (arm.wait_for_pose().sequence - begin < poses) continue;
}

/// Counts all servo calls, and the calls during or after the destruction of the servo.
struct Calls {
  std::atomic<int> all = 0, late = 0;
  std::atomic<bool> is_gone = false;
};

/// The servo's destructor waits for several poses of `clock`. A late call of the servo would occur during this wait.
Arm::Servo counting_servo(const std::shared_ptr<Calls>& calls, const Arm& clock) {
  struct Captured {
    std::shared_ptr<Calls> calls;
    const Arm& clock;
    ~Captured() {
      calls->is_gone = true;
      let_pass(clock);
    }
  };
  return [captured = std::shared_ptr<Captured>(new Captured{calls, clock})](const Pose&) {
    Calls& counted = *captured->calls;
    ++counted.all;
    if (counted.is_gone) ++counted.late;
    return Vector{};
  };
}

void wait_for_call(const Calls& calls, const Arm& clock) {
  for (const int before = calls.all; calls.all == before;) clock.wait_for_pose();
}

struct Bench {
  Board board;
  Arm clock{board.address};
  std::shared_ptr<Calls> calls = std::make_shared<Calls>();

  Arm with_servo() {
    Arm arm(board.address);
    arm.start_servo(counting_servo(calls, clock));
    wait_for_call(*calls, clock);
    return arm;
  }
};

/// Excludes this thread's allocations from leak detection.
struct LeakAllowed {
  LeakAllowed() {
#ifdef __SANITIZE_ADDRESS__
    __lsan_disable();
#endif
  }
  ~LeakAllowed() {
#ifdef __SANITIZE_ADDRESS__
    __lsan_enable();
#endif
  }
};

inkwell_result failure_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Failure& failure) {
    return failure.result;
  }
  return INKWELL_OK;
}

TEST_CASE("move assignment closes the old arm before it destroys its servo") {
  Bench bench;
  Arm arm = bench.with_servo();
  arm = Arm(bench.board.address);
  CHECK(bench.calls->is_gone);
  CHECK(bench.calls->late == 0);
  CHECK_FALSE(arm.servo_is_running());
}

TEST_CASE("a servo moves with its arm, and a moved-from arm refuses every call") {
  Bench bench;
  Arm first = bench.with_servo();
  Arm second = std::move(first);
  wait_for_call(*bench.calls, bench.clock);
  CHECK(second.servo_is_running());
  Arm& same = second;
  second = std::move(same);
  wait_for_call(*bench.calls, bench.clock);
  CHECK(second.servo_is_running());

  // NOLINTBEGIN(bugprone-use-after-move): this test uses a moved arm
  CHECK(first.get() == nullptr);
  CHECK_FALSE(first.servo_is_running());
  CHECK(failure_of([&] { first.start_servo([](const Pose&) { return Vector{}; }); }) == INKWELL_BAD_ARGUMENT);
  CHECK(failure_of([&] { first.stop_servo(); }) == INKWELL_BAD_ARGUMENT);
  CHECK(failure_of([&] { first.pose(); }) == INKWELL_BAD_ARGUMENT);
  first = std::move(second);
  // NOLINTEND(bugprone-use-after-move)
  wait_for_call(*bench.calls, bench.clock);
  CHECK_FALSE(bench.calls->is_gone);
  first.stop_servo();
  first.start_servo([](const Pose&) -> Vector { throw std::out_of_range("enough"); });
  CHECK(bench.calls->is_gone);
  while (first.servo_is_running()) bench.clock.wait_for_pose();
  second = std::move(first);
  CHECK_THROWS_AS(second.stop_servo(), std::out_of_range);
  CHECK_NOTHROW(second.stop_servo());
}

TEST_CASE("a servo that destroys its own arm continues with its state intact") {
  Bench bench;
  auto arm = std::make_unique<Arm>(bench.board.address);
  std::atomic<bool> ends = false, has_ended = false;
  {
    const LeakAllowed the_arm_stays_open;
    arm->start_servo([&, calls = counting_servo(bench.calls, bench.clock)](const Pose& pose) {
      arm.reset();
      if (!ends) return calls(pose);
      has_ended = true;
      throw std::runtime_error("ends the servo");
    });
  }
  for (int i = 0; i < 3; ++i) wait_for_call(*bench.calls, bench.clock);
  CHECK(arm == nullptr);
  CHECK_FALSE(bench.calls->is_gone);
  ends = true;
  while (!has_ended) bench.clock.wait_for_pose();
}

}  // namespace
}  // namespace inkwell::tests
