// Tests several threads on one arm, a blocking servo, and closing an arm during calls of other threads.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include <inkwell/inkwell.h>
#include "tests/dropins/board.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

/// The hand pulls the stylus out of the inkwell, so that the force can be enabled.
void take_out(Board& board, VirtualArm& arm) {
  arm.be_patient();
  arm.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  board.hold();
  arm.wait_until([](const auto& pose) { return pose.in_inkwell == 0; });
}

TEST_CASE("a servo callback that closes its arm gets an error") {
  VirtualArm virtual_arm;
  struct State {
    std::atomic<int> result = -1;
    std::string sentence;
  } state;
  const auto closes = [](inkwell_arm* arm, const inkwell_pose*, double*, void* user) {
    auto& self = *static_cast<State*>(user);
    const auto result = inkwell_close(arm);
    self.sentence = inkwell_error_text();
    self.result = result;
    return 1;
  };
  REQUIRE(inkwell_start_servo(virtual_arm.arm, closes, &state) == INKWELL_OK);
  virtual_arm.wait_until([&](const auto&) { return state.result != -1; });
  CHECK(state.result == INKWELL_REFUSED);
  CHECK(state.sentence.find("cannot close its own arm") != std::string::npos);
  CHECK(inkwell_stop_servo(virtual_arm.arm) == INKWELL_OK);
}

TEST_CASE("a program that only switched the force on takes it along, and the next one finds no fault") {
  Board board;
  {
    VirtualArm first(board.address);
    take_out(board, first);
    REQUIRE(inkwell_enable_force(first.arm, 60) == INKWELL_OK);
  }
  VirtualArm next(board.address);
  inkwell_pose pose{};
  REQUIRE(inkwell_get_pose(next.arm, &pose) == INKWELL_OK);
  CHECK(pose.state == INKWELL_READY);
  CHECK(pose.fault == INKWELL_FAULT_NONE);
}

TEST_CASE("closing takes the force away, and waits for a servo that does not return") {
  Board board;
  VirtualArm looks_on(board.address);
  take_out(board, looks_on);
  struct Gate {
    std::atomic<bool> is_in = false, may_go = false;
    void open() {
      may_go = true;
      may_go.notify_all();
    }
  } gate;
  const auto hangs = [](inkwell_arm*, const inkwell_pose* pose, double force_N[3], void* user) {
    force_N[0] = 1;
    if ((pose->force_sources & INKWELL_PROGRAM) == 0 || pose->state != INKWELL_ACTIVE) return 0;
    auto& self = *static_cast<Gate*>(user);
    self.is_in = true;
    self.may_go.wait(false);
    return 0;
  };
  inkwell_arm* arm = nullptr;
  REQUIRE(inkwell_open(board.address.c_str(), &arm) == INKWELL_OK);
  REQUIRE(inkwell_start_servo(arm, hangs, &gate) == INKWELL_OK);
  REQUIRE_MESSAGE(inkwell_enable_force(arm, 30.0) == INKWELL_OK, std::string(inkwell_error_text()));
  looks_on.wait_until([&](const auto&) { return gate.is_in.load(); });
  std::atomic<bool> is_closed = false;
  std::jthread closing([&] {
    inkwell_close(arm);
    is_closed = true;
  });
  const struct AtTheEnd {
    Gate& gate;
    ~AtTheEnd() { gate.open(); }
  } at_the_end{gate};
  // The program has switched the force off, so the state is ready. An expired force would lead to a different state.
  looks_on.wait_until(
      [](const auto& pose) { return pose.state == INKWELL_READY && (pose.force_sources & INKWELL_PROGRAM) == 0; });
  CHECK_FALSE(is_closed);
}

TEST_CASE("several threads can use servos, forces, poses and parameters simultaneously") {
  VirtualArm virtual_arm;
  inkwell_arm* const arm = virtual_arm.arm;
  std::atomic<bool> ends = false;
  std::array<std::atomic<int>, 4> rounds{};
  const auto repeat = [&](std::size_t number, auto action) {
    return std::thread([&, number, action] {
      while (!ends) {
        action();
        ++rounds[number];
      }
    });
  };
  const auto servo = [](inkwell_arm*, const inkwell_pose*, double*, void*) { return 0; };
  const auto starts_and_stops = [&] {
    inkwell_start_servo(arm, servo, nullptr);
    inkwell_stop_servo(arm);
  };
  std::vector<std::thread> threads;
  threads.push_back(repeat(0, starts_and_stops));
  threads.push_back(repeat(1, starts_and_stops));
  threads.push_back(repeat(2, [&] {
    const double force_N[3]{0.1, 0, 0};
    inkwell_set_force(arm, force_N);
    inkwell_move_virtual_hand(arm, free_point_m, hand_N_per_m);
    inkwell_press_virtual_buttons(arm, 1, 0);
  }));
  threads.push_back(repeat(3, [&] {
    const char* const name = "joint_1_maximum_rad";
    const double value = 0.98;
    double position_m[3], jacobian[9];
    const double joint_rad[3]{};
    inkwell_set_parameters(arm, &name, &value, 1);
    inkwell_forward_kinematics(arm, joint_rad, position_m, jacobian);
    inkwell_press_virtual_buttons(arm, 0, 1);
  }));
  virtual_arm.wait_until(
      [&](const auto&) {
        return std::all_of(rounds.begin(), rounds.end(), [](const auto& count) { return count > 20; });
      },
      60.0);
  ends = true;
  for (auto& thread : threads) thread.join();
  CHECK(inkwell_servo_is_running(arm) == 0);
}

TEST_CASE("a lost arm ends every call, in every thread, and its servo") {
  Board board;
  VirtualArm virtual_arm(board.address);
  inkwell_arm* const arm = virtual_arm.arm;
  const auto servo = [](inkwell_arm*, const inkwell_pose*, double*, void*) { return 0; };
  const char* const name = "supply_V";
  REQUIRE(inkwell_start_servo(arm, servo, nullptr) == INKWELL_OK);
  REQUIRE(inkwell_select_signals(arm, &name, 1) == INKWELL_OK);
  std::array<std::atomic<int>, 3> results{};
  std::thread waits([&] {
    inkwell_pose pose;
    while ((results[0] = inkwell_wait_for_pose(arm, 60.0, &pose)) == INKWELL_OK) continue;
  });
  std::thread reads([&] {
    float value = 0;
    std::size_t count = 0;
    while ((results[1] = inkwell_read_scope(arm, 60.0, &value, nullptr, 1, &count, nullptr)) == INKWELL_OK) continue;
  });
  std::thread drives([&] {
    const double force_N[3]{};
    while ((results[2] = inkwell_set_force(arm, force_N)) == INKWELL_OK) continue;
  });
  board.control.quit();
  for (auto* thread : {&waits, &reads, &drives}) thread->join();
  for (const auto& result : results) CHECK(result == INKWELL_DISCONNECTED);
  CHECK(inkwell_stop_servo(arm) == INKWELL_OK);
  CHECK(inkwell_start_servo(arm, servo, nullptr) == INKWELL_DISCONNECTED);
  double value = 0;
  CHECK(inkwell_get_parameter(arm, "wall_stiffness_N_per_m", &value) == INKWELL_DISCONNECTED);
  int is_referenced = 0;
  CHECK(inkwell_is_referenced(arm, &is_referenced) == INKWELL_DISCONNECTED);
}

TEST_CASE("changed parameters of the arm do not disturb its velocity") {
  VirtualArm virtual_arm;
  virtual_arm.hold_in_the_open();
  const char* const name = "joint_1_maximum_rad";
  const double value = 0.98;
  for (int i = 0; i < 5; ++i) {
    REQUIRE(inkwell_set_parameters(virtual_arm.arm, &name, &value, 1) == INKWELL_OK);
    for (int poses = 0; poses < 2; ++poses) {  // the first pose may have arrived earlier
      inkwell_pose pose;
      REQUIRE(inkwell_wait_for_pose(virtual_arm.arm, 10.0, &pose) == INKWELL_OK);
      CHECK(std::hypot(pose.velocity_m_s[0], pose.velocity_m_s[1], pose.velocity_m_s[2]) > 0.0);
    }
  }
}

}  // namespace
}  // namespace inkwell::tests
