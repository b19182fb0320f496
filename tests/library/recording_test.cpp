// A recording holds what the hand felt and why: marks, buttons, shapes, parameter changes, faults, texts and hashes.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "tests/dropins/board.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Returns the control period of the mark line with these words, or -1.
long long period_of(const std::string& content, const std::string& kind, const std::string& words) {
  for (std::size_t at = content.find("# mark "); at != std::string::npos; at = content.find("# mark ", at + 1)) {
    const std::string line = content.substr(at, content.find('\n', at) - at);
    if (line.find(" " + kind + " ") != std::string::npos && line.find(words) != std::string::npos)
      return std::stoll(line.substr(7));
  }
  return -1;
}

void select_signals(inkwell_arm* arm) {
  const char* const names[]{"position_z_m", "current_1_A", "duty_1"};
  REQUIRE(inkwell_select_signals(arm, names, 3) == INKWELL_OK);
}

}  // namespace

TEST_CASE("a recording holds marks, buttons, shapes, parameter changes and force sources with board time") {
  const TemporaryDirectory directory;
  const auto file = directory.file("felt.csv");
  VirtualArm virtual_arm;
  inkwell_arm* const arm = virtual_arm.arm;
  virtual_arm.make_active();
  CHECK(inkwell_mark(arm, "early") == INKWELL_REFUSED);
  CHECK(says("No recording is running"));
  select_signals(arm);
  REQUIRE(inkwell_describe_recordings(arm, "subject 7", "left hand") == INKWELL_OK);
  REQUIRE_MESSAGE(inkwell_start_recording(arm, file.c_str()) == INKWELL_OK, std::string(inkwell_error_text()));
  REQUIRE(inkwell_sleep(arm, 0.1) == INKWELL_OK);
  inkwell_pose pose;
  REQUIRE(inkwell_wait_for_pose(arm, 10.0, &pose) == INKWELL_OK);
  CHECK(inkwell_mark(arm, "stimulus") == INKWELL_OK);
  REQUIRE(inkwell_press_virtual_buttons(arm, 1, 0) == INKWELL_OK);
  REQUIRE(inkwell_sleep(arm, 0.1) == INKWELL_OK);
  const inkwell_plane plane{{0.0, 0.0, -0.02}, {0.0, 0.0, 1.0}, {400.0, 2.0, 0.0, 0.0, 10.0}};
  REQUIRE(inkwell_place_shapes(arm, &plane, 1, nullptr) == INKWELL_OK);
  virtual_arm.wait_until([](const auto& now) { return (now.force_sources & INKWELL_SHAPES) != 0; });
  const char* const name = "wall_stiffness_N_per_m";
  const double value = 500.0;
  REQUIRE(inkwell_set_parameters(arm, &name, &value, 1) == INKWELL_OK);
  REQUIRE(inkwell_sleep(arm, 0.1) == INKWELL_OK);
  REQUIRE(inkwell_stop(arm) == INKWELL_OK);
  REQUIRE(inkwell_sleep(arm, 0.1) == INKWELL_OK);
  std::uint64_t lost = 0;
  int is_complete = 0;
  REQUIRE(inkwell_finish_recording(arm, nullptr, &lost, &is_complete) == INKWELL_OK);
  CHECK(is_complete == (lost == 0 ? 1 : 0));

  const std::string content = text_of(file);
  CHECK(content.find("# name = subject 7\n# note = left hand\n") != std::string::npos);
  CHECK(content.find("# library_version = " + std::string(inkwell_version())) != std::string::npos);
  for (const char* hash : {"library", "image"})
    CHECK(content.find_first_of("\n ",
                                content.find(std::string("# ") + hash + "_sha256 = ") + std::string(hash).size() + 12) >
          content.find(std::string("# ") + hash + "_sha256 = ") + 70);
  CHECK(content.find("# clock ") != std::string::npos);
  const auto mark_period = period_of(content, "mark", "stimulus");
  CHECK(static_cast<double>(mark_period) >= pose.time_s * 20'000 - 0.5);
  CHECK(static_cast<double>(mark_period) <= pose.time_s * 20'000 + 2'000);
  CHECK(period_of(content, "button", "Button 1 was pressed.") >= mark_period);
  CHECK(period_of(content, "shape", "Plane 1: point (0, 0, -0.02) m, normal (0, 0, 1), 400 N/m") > mark_period);
  CHECK(period_of(content, "source", "shapes") > mark_period);
  CHECK(period_of(content, "parameter", "wall_stiffness_N_per_m = 500.0, was 800.0") > mark_period);
  CHECK(period_of(content, "force", "The force is off.") > mark_period);
}

TEST_CASE("a recording holds the parameter changes of other programs") {
  const TemporaryDirectory directory;
  const auto file = directory.file("other.csv");
  const Board board;
  const VirtualArm virtual_arm{board.address}, other{board.address};
  inkwell_arm* const arm = virtual_arm.arm;
  select_signals(arm);
  const auto set = [](inkwell_arm* by, const char* name, double value) {
    REQUIRE_MESSAGE(inkwell_set_parameters(by, &name, &value, 1) == INKWELL_OK, std::string(inkwell_error_text()));
  };
  set(other.arm, "wall_damping_Ns_per_m", 3.0);  // before the recording
  REQUIRE_MESSAGE(inkwell_start_recording(arm, file.c_str()) == INKWELL_OK, std::string(inkwell_error_text()));
  REQUIRE(inkwell_sleep(arm, 0.1) == INKWELL_OK);
  set(other.arm, "wall_stiffness_N_per_m", 500.0);
  set(arm, "wall_stiffness_N_per_m", 600.0);
  REQUIRE(inkwell_sleep(arm, 1.5) == INKWELL_OK);
  set(other.arm, "wall_stiffness_N_per_m", 700.0);
  std::uint64_t samples = 0;
  REQUIRE(inkwell_stop_recording(arm, &samples, nullptr) == INKWELL_OK);
  const std::string content = text_of(file);
  CHECK(period_of(content, "parameter", "wall_stiffness_N_per_m = 500.0, was 800.0, by another program") > 0);
  CHECK(period_of(content, "parameter", "wall_stiffness_N_per_m = 600.0, was 500.0") > 0);
  CHECK(period_of(content, "parameter", "wall_stiffness_N_per_m = 700.0, was 600.0, by another program") > 0);
  CHECK(period_of(content, "parameter", "wall_stiffness_N_per_m = 600.0, was 500.0, by") == -1);
  CHECK(period_of(content, "parameter", "wall_damping") == -1);
}

TEST_CASE("a recording with an unplugged cable is not complete, and the message names the remedy that works") {
  const TemporaryDirectory directory;
  const auto file = directory.file("unplugged.csv");
  Board board;
  VirtualArm virtual_arm{board.address};
  inkwell_arm* const arm = virtual_arm.arm;
  select_signals(arm);
  REQUIRE_MESSAGE(inkwell_start_recording(arm, file.c_str()) == INKWELL_OK, std::string(inkwell_error_text()));
  REQUIRE(inkwell_sleep(arm, 0.1) == INKWELL_OK);
  board.control.usb(false);
  inkwell_pose pose;
  for (int i = 0; i < 12'000 && inkwell_get_pose(arm, &pose) != INKWELL_DISCONNECTED; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  REQUIRE(inkwell_get_pose(arm, &pose) == INKWELL_DISCONNECTED);
  CHECK_MESSAGE(says("cable"), std::string(inkwell_error_text()));
  CHECK_MESSAGE(says("plug the cable in and clear the fault"), std::string(inkwell_error_text()));
  int is_complete = 1;
  std::uint64_t samples = 0;
  REQUIRE(inkwell_finish_recording(arm, &samples, nullptr, &is_complete) == INKWELL_OK);
  CHECK(samples > 1000);
  CHECK(is_complete == 0);
  CHECK(text_of(file).find("# complete = 0\n") != std::string::npos);
  CHECK(period_of(text_of(file), "connection", "cable") > 0);
}

TEST_CASE("a servo that takes too long is counted with its missed poses, and other losses stay 0") {
  VirtualArm virtual_arm;
  inkwell_arm* const arm = virtual_arm.arm;
  inkwell_losses losses{1, 1, 1, 1.0};
  REQUIRE(inkwell_get_losses(arm, &losses) == INKWELL_OK);
  CHECK(losses.slow_servo_calls == 0);
  CHECK(losses.longest_servo_call_s == 0.0);
  const inkwell_servo slow = [](inkwell_arm*, const inkwell_pose*, double*, void* user) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    return ++*static_cast<int*>(user) < 3 ? 0 : 1;
  };
  int calls = 0;
  REQUIRE(inkwell_start_servo(arm, slow, &calls) == INKWELL_OK);
  for (int i = 0; i < 1000 && inkwell_servo_is_running(arm) != 0; ++i) inkwell_sleep(arm, 0.001);
  REQUIRE(inkwell_get_losses(arm, &losses) == INKWELL_OK);
  CHECK(losses.slow_servo_calls == 3);
  CHECK(losses.longest_servo_call_s >= 0.03);
  CHECK(losses.poses_missed_by_servo == 0);  // the board waits for the servo
  CHECK(inkwell_get_losses(arm, nullptr) == INKWELL_BAD_ARGUMENT);
}

TEST_CASE("a test pulse is sent in the state ready, and refused with the remedy otherwise") {
  VirtualArm virtual_arm;
  inkwell_arm* const arm = virtual_arm.arm;
  virtual_arm.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
  CHECK(inkwell_send_test_pulse(arm, 4, INKWELL_PULSE_V, 1.0, 0.005) == INKWELL_BAD_ARGUMENT);
  CHECK(inkwell_send_test_pulse(arm, 1, INKWELL_PULSE_V, 1.0, 0.2) == INKWELL_BAD_ARGUMENT);
  CHECK(says("at most 0.1 s"));
  select_signals(arm);
  REQUIRE_MESSAGE(inkwell_send_test_pulse(arm, 1, INKWELL_PULSE_V, 1.5, 0.005) == INKWELL_OK,
                  std::string(inkwell_error_text()));
  REQUIRE(inkwell_sleep(arm, 0.02) == INKWELL_OK);
  float largest_A = 0, largest_duty = 0;
  int pulse_periods = 0;
  for (std::size_t count = 1; count > 0;) {
    float values[3 * 512];
    REQUIRE(inkwell_read_samples(arm, 0.02, values, nullptr, 512, &count, nullptr) == INKWELL_OK);
    for (std::size_t i = 0; i < count; ++i) {
      largest_A = std::max(largest_A, values[3 * i + 1]);
      largest_duty = std::max(largest_duty, values[3 * i + 2]);
      pulse_periods += values[3 * i + 2] > 0.01f;
    }
    if (pulse_periods >= 100 && largest_A > 0.3f) break;
  }
  CHECK(largest_A > 0.3f);
  CHECK(largest_duty > 0.03f);
  CHECK(pulse_periods == 100);
  CHECK(inkwell_select_signals(arm, nullptr, 0) == INKWELL_OK);
  virtual_arm.make_active();
  CHECK(inkwell_send_test_pulse(arm, 1, INKWELL_PULSE_A, 0.5, 0.005) == INKWELL_REFUSED);
  CHECK(says("state ready"));
}

}  // namespace inkwell::tests
