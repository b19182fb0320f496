// Tests when the time of virtual boards advances in lock step.
#include <doctest/doctest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/turns.hpp"

namespace inkwell::tests {
namespace {

using library::Loss, library::PoseFeed, library::Turns;

/// This board sends each requested pose immediately.
class SteppedBoard {
 public:
  SteppedBoard(PoseFeed& poses, std::shared_ptr<Turns> turns, bool is_stepped, std::uint32_t poses_before_open = 1)
      : poses_(poses) {
    poses_.take_turns(std::move(turns), is_stepped);
    thread_ = std::thread([this, poses_before_open] {
      while (poses_.begin_turn()) {
        inkwell_pose pose{};
        pose.sequence = ++sequence_;
        pose.time_s = 1e-3 * pose.sequence;
        poses_.publish(pose, true);
        if (pose.sequence == poses_before_open) poses_.let_program_decide();
        if (pose.sequence == loses_link_at_) poses_.lose(Loss::link, "It is gone.");
      }
    });
    poses_.wait([](const auto& pose, Loss) { return pose.sequence > 0; });
  }
  ~SteppedBoard() {
    poses_.leave_turns();
    thread_.join();
  }
  std::uint32_t sequence() const { return sequence_; }
  void lose_link_at(std::uint32_t sequence) { loses_link_at_ = sequence; }

 private:
  PoseFeed& poses_;
  std::atomic<std::uint32_t> sequence_ = 0, loses_link_at_ = 0;
  std::thread thread_;
};

std::function<bool(const inkwell_pose&, Loss)> reaches(std::uint32_t sequence) {
  return [=](const inkwell_pose& pose, Loss) { return pose.sequence >= sequence; };
}

TEST_CASE("a stepped board's time passes only while a call waits, and exactly as far as it waits") {
  PoseFeed poses;
  const SteppedBoard board(poses, std::make_shared<Turns>(), true);
  for (const std::uint32_t sequence : {1u, 2u, 10u, 500u}) {
    CHECK(poses.wait(reaches(sequence)).sequence == sequence);
    CHECK(board.sequence() == sequence);
  }
  CHECK(poses.wait([](const auto&, Loss) { return false; }, 0.0).sequence == 500);   // checks once without waiting
  CHECK(poses.wait([](const auto&, Loss) { return false; }, 0.25).sequence == 750);  // 0.25 s of board time
  CHECK(board.sequence() == 750);
}

TEST_CASE("a call waits for what comes between two poses until the next pose, with the board standing still") {
  PoseFeed poses;
  const SteppedBoard board(poses, std::make_shared<Turns>(), true);
  int asked = 0;
  REQUIRE(poses.is_in_step());
  CHECK(poses.wait([&] { return ++asked == 4; }, std::chrono::seconds(60)));  // checked once before the first turn
  CHECK(board.sequence() == 4);
  CHECK_FALSE(poses.wait([] { return false; }, std::chrono::milliseconds(100)));
  CHECK(board.sequence() == 104);
}

TEST_CASE("the next pose is requested only after the servo has answered, and the answer of the servo is sent first") {
  struct Part : library::TurnPart {
    std::atomic<std::uint32_t> answered = 0, sent = 0, read = 0;
    void before_pose() override { sent = answered.load(); }
    void after_pose() override { ++read; }
  } part;
  PoseFeed poses;
  const SteppedBoard board(poses, std::make_shared<Turns>(), false);
  poses.add(part);
  std::atomic<bool> ends = false;
  std::thread servo([&] {
    std::uint32_t seen = poses.last().pose.sequence;
    poses.begin_answer(std::this_thread::get_id(), Turns::Answer::servo);
    seen = poses.last().pose.sequence;
    for (int i = 0; i < 200; ++i) {
      const auto pose = poses.wait([&](const auto& newest, Loss) { return newest.sequence != seen; },
                                   library::forever_s, Turns::Answer::servo);
      CHECK(pose.sequence == seen + 1);
      CHECK(board.sequence() == pose.sequence);  // the board has not advanced
      if (i > 0) CHECK(part.sent == seen);
      seen = pose.sequence;
      if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      part.answered = seen;
    }
    poses.end_answer(std::this_thread::get_id());
    ends = true;
  });
  servo.join();
  CHECK(part.read > 0);
  poses.remove(part);
  const std::uint32_t now = board.sequence();
  CHECK(poses.wait(reaches(now + 10)).sequence >= now + 10);
}

TEST_CASE("a servo that waits in the library does not delay the pose that it waits for") {
  PoseFeed poses;
  const SteppedBoard board(poses, std::make_shared<Turns>(), true);
  std::thread servo([&] {
    poses.begin_answer(std::this_thread::get_id(), Turns::Answer::servo);
    CHECK(poses.wait(reaches(20)).sequence == 20);
    CHECK(board.sequence() == 20);  // and answers again
    poses.end_answer(std::this_thread::get_id());
  });
  servo.join();
  CHECK(poses.wait(reaches(21)).sequence == 21);
}

TEST_CASE("boards of one group have the same time, and one that leaves holds up no other") {
  const auto turns = std::make_shared<Turns>();
  PoseFeed poses[2];
  std::optional<SteppedBoard> first(std::in_place, poses[0], turns, false);
  poses[0].wait(reaches(100));
  std::optional<SteppedBoard> second(std::in_place, poses[1], turns, true);
  const std::uint32_t ahead = first->sequence() - second->sequence();
  for (const std::uint32_t sequence : {200u, 201u, 400u}) {
    CHECK(poses[1].wait(reaches(sequence)).sequence == sequence);
    CHECK(first->sequence() - second->sequence() == ahead);
  }
  second.reset();
  CHECK(poses[0].wait(reaches(2000)).sequence >= 2000);
}

TEST_CASE("the board waits for a loop that drives, but not indefinitely") {
  PoseFeed poses;
  const SteppedBoard board(poses, std::make_shared<Turns>(), false);
  std::uint32_t seen = poses.last().pose.sequence;
  const auto next = [&] {
    const auto pose = poses.wait([&](const auto& newest, Loss) { return newest.sequence != seen; }, library::forever_s,
                                 Turns::Answer::loop);
    const bool is_newest = pose.sequence == board.sequence();
    seen = pose.sequence;
    return is_newest;
  };
  for (int i = 0; i < 50; ++i) {
    if (i > 0) CHECK(board.sequence() == seen);
    CHECK(next());
  }
  std::thread other([&] { CHECK(poses.wait(reaches(seen + 5)).sequence >= seen + 5); });  // the loop is over
  other.join();
}

TEST_CASE("a lost link ends every wait, and its board takes turns with the others again afterwards") {
  const auto turns = std::make_shared<Turns>();
  PoseFeed poses[2];
  struct Part : library::TurnPart {
    std::atomic<int> losses = 0;
    void lose_link(const std::string& cause) override { losses += cause == "It is gone." ? 1 : 0; }
  } part;
  std::optional<SteppedBoard> other(std::in_place, poses[1], turns, false);
  std::optional<SteppedBoard> board(std::in_place, poses[0], turns, true);
  poses[0].add(part);
  board->lose_link_at(50);
  std::thread waits(
      [&] { CHECK_THROWS_AS(poses[0].wait([](const auto&, Loss) { return false; }), device::Disconnected); });
  waits.join();
  while (poses[0].last().pose.sequence < 51) std::this_thread::yield();  // a wait would end with the loss
  CHECK(part.losses == 1);
  poses[0].let_program_decide();
  const auto now = poses[0].wait([](const auto&, Loss) { return false; }, 0.1);
  CHECK(board->sequence() == now.sequence);
  const std::uint32_t ahead = other->sequence() - now.sequence;
  poses[0].wait(reaches(now.sequence + 100));
  CHECK(other->sequence() - board->sequence() == ahead);
  poses[0].remove(part);
}

}  // namespace
}  // namespace inkwell::tests
