// Tests a lost connection to an open arm, with the effect on arm, force and servo.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <inkwell/inkwell.hpp>
#include "tests/dropins/board.hpp"
#include "tests/system/program.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

const double push_N[3]{1, 0, 0};

/// Waits for at most one minute.
bool eventually(auto condition) {
  for (int i = 0; i < 12'000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return condition();
}

int goes_on(inkwell_arm*, const inkwell_pose*, double force_N[3], void*) {
  force_N[0] = 1;
  return 0;
}

/// A board with a servo; the servo sends forces.
struct Driven : Board {
  VirtualArm driver{address};
  inkwell_arm* const arm = driver.arm;

  Driven() {
    driver.be_patient();
    driver.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
    hold();
    driver.wait_until([](const auto& pose) { return pose.in_inkwell == 0; });
  }
  void drive() {
    REQUIRE_MESSAGE(inkwell_enable_force(arm, 30) == INKWELL_OK, std::string(inkwell_error_text()));
    REQUIRE_MESSAGE(inkwell_start_servo(arm, goes_on, nullptr) == INKWELL_OK, std::string(inkwell_error_text()));
    driver.wait_until([](const auto& pose) { return pose.force_N[0] > 0.9; });
  }
  inkwell_result pose_result() const {
    inkwell_pose pose;
    return inkwell_get_pose(arm, &pose);
  }
  /// Checks that poses, forces and the servo have stopped, and that each call reports the cause.
  void check_lost(const std::string& cause) {
    REQUIRE(eventually([&] { return pose_result() == INKWELL_DISCONNECTED; }));
    CHECK_MESSAGE(says(cause), std::string(inkwell_error_text()));
    inkwell_pose last{};
    last.position_m[0] = 7;
    REQUIRE(inkwell_get_pose(arm, &last) == INKWELL_DISCONNECTED);
    CHECK(last.sequence > 0);
    CHECK(std::abs(last.position_m[0] - held_point_m[0]) < 0.01);
    int is_referenced = 7;
    CHECK(inkwell_is_referenced(arm, &is_referenced) == INKWELL_DISCONNECTED);
    CHECK(is_referenced == 1);
    CHECK(inkwell_set_force(arm, push_N) == INKWELL_DISCONNECTED);
    CHECK(inkwell_enable_force(arm, 1) == INKWELL_DISCONNECTED);
    double value = 0;
    CHECK(inkwell_get_parameter(arm, "wall_stiffness_N_per_m", &value) == INKWELL_DISCONNECTED);
    REQUIRE(eventually([&] { return inkwell_servo_is_running(arm) == 0; }));
    CHECK(inkwell_servo_result(arm) == INKWELL_DISCONNECTED);
    CHECK_MESSAGE(says(cause), std::string(inkwell_error_text()));
    CHECK(inkwell_start_servo(arm, goes_on, nullptr) == INKWELL_DISCONNECTED);
  }
};

TEST_CASE("a lost arm comes back, with the force off after a lost link") {
  Driven board;
  inkwell_pose last;

  board.drive();
  board.control.pause();
  board.check_lost("No pose has arrived for 2 s");
  CHECK(inkwell_wait_for_pose(board.arm, 0.01, &last) == INKWELL_TIMED_OUT);
  board.control.resume();
  REQUIRE(inkwell_wait_for_pose(board.arm, 60, &last) == INKWELL_OK);
  CHECK(board.pose_result() == INKWELL_OK);
  board.drive();

  board.control.usb(false);
  board.check_lost("its cable was unplugged");
  last.sequence = 0;
  CHECK(inkwell_wait_for_pose(board.arm, 60, &last) == INKWELL_DISCONNECTED);
  CHECK(last.sequence > 0);
  board.control.usb(true);
  REQUIRE(eventually([&] { return board.pose_result() == INKWELL_OK; }));
  CHECK(inkwell_set_force(board.arm, push_N) == INKWELL_FORCE_LOST);
  CHECK(says("The link to the arm was lost"));
  CHECK(board.driver.wait_until([](const auto&) { return true; }).force_N[0] == 0.0);
  board.driver.be_patient();
  board.drive();  // the fault usb_gone belongs to the previous connection

  board.control.reset();
  board.check_lost("restarted");
  REQUIRE(eventually([&] { return board.pose_result() == INKWELL_OK; }));
  board.driver.wait_until([](const auto& pose) { return pose.state == INKWELL_UNREFERENCED; });
  CHECK(inkwell_set_force(board.arm, push_N) == INKWELL_FORCE_LOST);
  board.control.dock(true);
  board.driver.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  board.control.dock(false);
  board.driver.be_patient();
  board.drive();
}

/// This virtual board exits and starts again on the same port.
struct Program {
  std::string port = "0";
  std::optional<RunningProgram> board;

  void start(const std::string& seed) {
    board.emplace(std::vector<std::string>{build_directory() + "/virtual-board", "--elf",
                                           build_directory() + "/../board/inkwell.elf", "--real-time", "--usbip", port,
                                           "--seed", seed});
    const std::string ready = board->read_line(), name = "usbip=";
    const auto begin = ready.find(name) + name.size();
    port = ready.substr(begin, ready.find(' ', begin) - begin);
  }
};

TEST_CASE("the program of a board may end and start again; another arm at its address is not taken for it") {
  Program program;
  program.start("1");
  VirtualArm virtual_arm("usbip:127.0.0.1:" + program.port);
  inkwell_pose pose;
  const auto result = [&] { return inkwell_get_pose(virtual_arm.arm, &pose); };
  program.board.reset();
  REQUIRE(eventually([&] { return result() == INKWELL_DISCONNECTED; }));
  program.start("2");
  REQUIRE(eventually([&] { return result() == INKWELL_DISCONNECTED && says("Another arm"); }));
  program.board.reset();
  program.start("1");
  REQUIRE(eventually([&] { return result() == INKWELL_OK; }));
  virtual_arm.wait_until([](const auto& now) { return now.state == INKWELL_READY; });
}

TEST_CASE("a lost connection ends the signal selection with an error, and a new selection is possible") {
  Board board;
  VirtualArm virtual_arm(board.address);
  inkwell_arm* const arm = virtual_arm.arm;
  const char* const name = "supply_V";
  float value = 0;
  std::size_t count = 0;
  const auto read = [&] { return inkwell_read_scope(arm, 60, &value, nullptr, 1, &count, nullptr); };
  REQUIRE(inkwell_select_signals(arm, &name, 1) == INKWELL_OK);
  REQUIRE(read() == INKWELL_OK);
  board.control.usb(false);
  REQUIRE(eventually([&] { return read() == INKWELL_DISCONNECTED; }));
  board.control.usb(true);
  inkwell_pose pose;
  REQUIRE(eventually([&] { return inkwell_get_pose(arm, &pose) == INKWELL_OK; }));
  CHECK(read() == INKWELL_DISCONNECTED);
  CHECK(says("select the signals again"));
  CHECK(inkwell_start_recording(arm, "none.csv") == INKWELL_REFUSED);
  REQUIRE_MESSAGE(inkwell_select_signals(arm, &name, 1) == INKWELL_OK, std::string(inkwell_error_text()));
  REQUIRE(read() == INKWELL_OK);
  CHECK(count == 1);
}

TEST_CASE("a force that another program or a fault takes away ends the servo, with the cause") {
  Driven board;
  const VirtualArm other(board.address);
  const auto check_lost = [&](const std::string& cause) {
    REQUIRE(eventually([&] { return inkwell_servo_is_running(board.arm) == 0; }));
    CHECK(inkwell_servo_result(board.arm) == INKWELL_FORCE_LOST);
    CHECK_MESSAGE(says(cause), std::string(inkwell_error_text()));
    CHECK(inkwell_set_force(board.arm, push_N) == INKWELL_FORCE_LOST);
    CHECK_MESSAGE(says(cause), std::string(inkwell_error_text()));
    CHECK(inkwell_stop_servo(board.arm) == INKWELL_OK);
    CHECK(board.driver.wait_until([](const auto& pose) { return pose.force_N[0] == 0.0; }).force_sources == 0);
  };
  board.drive();
  REQUIRE(inkwell_stop(other.arm) == INKWELL_OK);
  check_lost("Another program switched the force off");
  board.drive();
  CHECK(inkwell_servo_result(board.arm) == INKWELL_OK);
  board.control.inject({"bridge_fault"});
  check_lost("bridge_fault");
  board.control.heal("bridge_fault");
  REQUIRE(inkwell_clear_fault(board.arm) == INKWELL_OK);
  board.drive();

  // No loss is reported if the program itself switches the force off.
  REQUIRE(inkwell_disable_force(board.arm) == INKWELL_OK);
  board.driver.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  const auto off = board.driver.wait_until([](const auto&) { return true; });
  CHECK(off.force_sources == 0);
  CHECK(inkwell_servo_is_running(board.arm) == 1);
  REQUIRE(inkwell_enable_force(board.arm, 30) == INKWELL_OK);
  board.driver.wait_until([](const auto& pose) { return pose.force_N[0] > 0.9; });
  CHECK(inkwell_stop_servo(board.arm) == INKWELL_OK);
  CHECK(inkwell_servo_result(board.arm) == INKWELL_OK);
}

TEST_CASE("the force can be switched on after a program that went away with its force on") {
  Board board;
  {
    VirtualArm before(board.address);
    before.be_patient();
    before.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
    board.hold();
    before.wait_until([](const auto& pose) { return pose.in_inkwell == 0; });
    REQUIRE(inkwell_enable_force(before.arm, 30) == INKWELL_OK);
    board.control.usb(false);
  }
  board.control.usb(true);
  board.wait_for_device();
  VirtualArm after(board.address);
  after.be_patient();
  CHECK(after.wait_until([](const auto&) { return true; }).fault == INKWELL_FAULT_USB_GONE);
  CHECK_MESSAGE(inkwell_enable_force(after.arm, 30) == INKWELL_OK, std::string(inkwell_error_text()));
}

TEST_CASE("a C++ exception contains the last pose, and the reason for the end of a servo is thrown once") {
  Driven board;
  inkwell::Arm arm(board.address);
  const double x_m = arm.pose().position_m[0];
  REQUIRE(inkwell_enable_force(board.arm, 30) == INKWELL_OK);
  board.control.usb(false);
  REQUIRE(eventually([&] {
    try {
      arm.pose();
      return false;
    } catch (const inkwell::Disconnected& lost) {
      CHECK(lost.result == INKWELL_DISCONNECTED);
      return std::abs(lost.last_pose.position_m[0] - x_m) < 0.01;
    }
  }));
  CHECK_THROWS_AS(arm.set_force({1, 0, 0}), inkwell::Failure);
  board.control.usb(true);
  REQUIRE(eventually([&] { return board.pose_result() == INKWELL_OK; }));
  inkwell_close(board.driver.arm);
  board.driver.arm = nullptr;

  REQUIRE(eventually([&] {
    try {
      arm.enable_force(30);
      return true;
    } catch (const inkwell::Disconnected&) {
      return false;
    }
  }));
  arm.start_servo([](const inkwell::Pose&) { return inkwell::Vector{}; });
  board.control.inject({"bridge_fault"});
  REQUIRE(eventually([&] { return !arm.servo_is_running(); }));
  inkwell_result thrown = INKWELL_OK;
  try {
    arm.wait_for_pose(60);
  } catch (const inkwell::Failure& failure) {
    thrown = failure.result;
  }
  CHECK(thrown == INKWELL_FORCE_LOST);
  CHECK_NOTHROW(arm.wait_for_pose(60));
  CHECK_NOTHROW(arm.stop_servo());
}

}  // namespace
}  // namespace inkwell::tests
