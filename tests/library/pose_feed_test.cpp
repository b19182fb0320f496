// Tests the reports of lost poses and of a lost force, without a board.
#include <doctest/doctest.h>

#include "host/client/device/error.hpp"
#include "tests/failure.hpp"

#include "host/bindings/library/errors.hpp"
#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/servo.hpp"

namespace inkwell::tests {
namespace {

using library::Loss, library::PoseFeed, library::Servo;

/// This board passes through a sequence of states.
struct Board {
  PoseFeed poses;
  std::uint32_t sequence = 0;

  void is(inkwell_state state, int fault = INKWELL_FAULT_NONE) {
    inkwell_pose pose{};
    pose.sequence = ++sequence;
    pose.state = state;
    pose.fault = fault;
    pose.position_m[0] = 0.001 * sequence;
    poses.publish(pose, true);
  }
};

std::string cause_of_lost_force(const PoseFeed& poses) {
  return message_of<library::ForceLost>([&] { poses.require_force(); });
}

TEST_CASE("lost poses: getters fail with the cause, the last pose stays, and the next one ends the loss") {
  Board board;
  board.is(INKWELL_READY);
  for (const auto kind : {Loss::silence, Loss::link}) {
    CAPTURE(static_cast<int>(kind));
    board.poses.lose(kind, "The cause.");
    double x_m = 0;
    const auto read = [&] { board.poses.read([&](const auto& last) { x_m = last.pose.position_m[0]; }); };
    CHECK(message_of<device::Disconnected>(read) == "The cause.");
    CHECK(x_m == 0.001 * board.sequence);
    CHECK_THROWS_AS(board.poses.require_poses(), device::Disconnected);
    if (kind == Loss::link) CHECK_THROWS_AS(board.poses.require_link(), device::Disconnected);
    if (kind == Loss::silence) CHECK_NOTHROW(board.poses.require_link());
    board.is(INKWELL_READY);
    CHECK_NOTHROW(read());
    CHECK(x_m == 0.001 * board.sequence);
  }
}

TEST_CASE("a wait ends with the link, but outlasts a silence") {
  Board board;
  board.is(INKWELL_READY);
  const auto never = [](const auto&, Loss) { return false; };
  board.poses.lose(Loss::silence, "Silent.");
  CHECK_NOTHROW(board.poses.wait(never, 0.001));
  board.poses.lose(Loss::link, "Unplugged.");
  CHECK_THROWS_WITH_AS(board.poses.wait(never), "Unplugged.", device::Disconnected);
}

TEST_CASE("a force that goes off against the program's will is lost, and the cause is named") {
  Board board;
  board.is(INKWELL_ACTIVE);
  SUBCASE("of another program, before this one drives") {
    board.is(INKWELL_READY);
    CHECK(cause_of_lost_force(board.poses) == "");
  }
  board.poses.use_force();
  board.is(INKWELL_ACTIVE);
  SUBCASE("by a fault") {
    board.is(INKWELL_FAULT, INKWELL_FAULT_HOST_SILENT);
    CHECK(contains(cause_of_lost_force(board.poses), "A fault switched the force off. host_silent: "));
  }
  SUBCASE("by another program") {
    board.is(INKWELL_READY);
    CHECK(contains(cause_of_lost_force(board.poses), "Another program"));
  }
  SUBCASE("by a restart of the board") {
    board.is(INKWELL_STARTING);
    CHECK(contains(cause_of_lost_force(board.poses), "restarted"));
  }
  SUBCASE("with the reference of the arm") {
    board.is(INKWELL_UNREFERENCED);
    CHECK(contains(cause_of_lost_force(board.poses), "inkwell"));
  }
  SUBCASE("by this program, which is no loss") {
    board.poses.expect_force_off();
    board.is(INKWELL_ACTIVE);
    board.is(INKWELL_READY);
    CHECK(cause_of_lost_force(board.poses) == "");
    board.is(INKWELL_ACTIVE);
    board.is(INKWELL_READY);
    CHECK(cause_of_lost_force(board.poses) != "");  // switched off by another program
  }
  SUBCASE("by a fault while this program lets it fall") {
    board.poses.expect_force_off();
    board.is(INKWELL_FAULT, INKWELL_FAULT_OVER_CURRENT);
    CHECK(cause_of_lost_force(board.poses) != "");
  }
  SUBCASE("with the link, even if the board is still active afterwards") {
    board.poses.lose(Loss::link, "Unplugged.");
    board.is(INKWELL_ACTIVE);
    CHECK(contains(cause_of_lost_force(board.poses), "link"));
    board.is(INKWELL_READY);
    CHECK(contains(cause_of_lost_force(board.poses), "Another program"));
  }
  SUBCASE("and it is back with the force, or forgotten") {
    board.is(INKWELL_READY);
    board.is(INKWELL_ACTIVE);
    CHECK(cause_of_lost_force(board.poses) == "");
    board.is(INKWELL_READY);
    CHECK(cause_of_lost_force(board.poses) != "");
    board.poses.forget_lost_force();
    CHECK(cause_of_lost_force(board.poses) == "");
  }
}

TEST_CASE("whose fault it is: the force was on in this link, or not") {
  Board board;
  board.is(INKWELL_ACTIVE);
  CHECK_FALSE(board.poses.had_force());
  board.poses.use_force();
  board.is(INKWELL_ACTIVE);
  CHECK(board.poses.had_force());
  board.is(INKWELL_FAULT, INKWELL_FAULT_HOST_SILENT);
  CHECK(board.poses.had_force());
  board.poses.lose(Loss::link, "Unplugged.");
  board.is(INKWELL_FAULT, INKWELL_FAULT_USB_GONE);
  CHECK_FALSE(board.poses.had_force());
}

TEST_CASE("a servo stops with the force or with the poses and reports the reason, and a new servo can start") {
  Board board;
  board.poses.use_force();
  board.is(INKWELL_ACTIVE);
  std::atomic<int> let_go = 0;
  Servo servo(
      board.poses, [](const double(&)[3], std::uint32_t) {}, [&] { ++let_go; });
  const auto ends = [&] {
    for (int i = 0; i < 100'000 && servo.is_running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK_FALSE(servo.is_running());
  };
  const auto goes_on = [](const inkwell_pose&, double(&)[3]) { return true; };
  CHECK_NOTHROW(servo.throw_what_ended_it());
  servo.start(goes_on);
  SUBCASE("a fault") {
    board.is(INKWELL_FAULT, INKWELL_FAULT_OVER_SPEED);
    ends();
    CHECK(contains(message_of<library::ForceLost>([&] { servo.throw_what_ended_it(); }), "over_speed"));
  }
  SUBCASE("a fault clears before the servo reads it") {
    board.is(INKWELL_FAULT, INKWELL_FAULT_OVER_SPEED);
    board.is(INKWELL_ACTIVE);
    ends();
    CHECK_THROWS_AS(servo.throw_what_ended_it(), library::ForceLost);
  }
  SUBCASE("a silence") {
    board.poses.lose(Loss::silence, "Silent.");
    ends();
    CHECK_THROWS_WITH_AS(servo.throw_what_ended_it(), "Silent.", device::Disconnected);
  }
  SUBCASE("a lost link") {
    board.poses.lose(Loss::link, "Unplugged.");
    ends();
    CHECK_THROWS_WITH_AS(servo.throw_what_ended_it(), "Unplugged.", device::Disconnected);
  }
  SUBCASE("the program") {
    servo.stop();
    CHECK_NOTHROW(servo.throw_what_ended_it());
  }
  CHECK(let_go == 1);
  board.is(INKWELL_READY);
  servo.start(goes_on);
  CHECK_NOTHROW(servo.throw_what_ended_it());
  CHECK(servo.is_running());
}

}  // namespace
}  // namespace inkwell::tests
