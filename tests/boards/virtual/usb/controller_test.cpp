// Tests the flashed firmware's multi-axis controller in parallel with poses and scope.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

TEST_CASE("the controller report follows the pose every 8 ms, and no pose or sample is lost") {
  using protocol::Signal;
  FirmwareOnBus bus(flashed_image());
  bus.connect();
  bus.run_for(0.01);
  std::optional<protocol::PoseReport> pose;
  std::uint32_t poses = 0, poses_lost = 0, reports = 0;
  bool is_referenced = false, is_taking_reference = false;
  bus.on_pose = [&](const protocol::PoseReport& newest) {
    if (pose) poses_lost += newest.sequence - pose->sequence - 1;
    pose = newest;
    ++poses;
  };
  bus.on_controller_report = [&](std::span<const std::byte> bytes) {
    protocol::ControllerReport report;
    REQUIRE(bytes.size() == sizeof report);
    std::memcpy(&report, bytes.data(), sizeof report);
    ++reports;
    if (!pose || is_taking_reference) return;
    for (int i = 0; i < 3; ++i) {
      const float position_m = is_referenced ? pose->position_m[i] : 0.0f;
      CHECK(report.position[i] == std::lround(std::clamp(position_m * 1e5f, -32767.0f, 32767.0f)));
      CHECK(report.angle[i] == std::lround(std::clamp(pose->gimbal_rad[i] * 1e4f, -32767.0f, 32767.0f)));
    }
  };
  std::uint32_t scope_frames = 0;
  bus.on_scope_frame = [&](std::span<const std::byte>) { ++scope_frames; };
  bus.keep_asking_for_poses();
  bus.keep_asking_the_controller();
  bus.stream_scope(std::array{Signal::position_x_m, Signal::force_N});
  bus.run_for(0.2);
  REQUIRE(pose);
  CHECK(int{pose->is_referenced} == 0);
  is_taking_reference = true;
  const auto& closed = board::omni_driver.inkwell_switch;
  bus.chip.input_pins().drive(closed.port, closed.number, virtual_board::PinLevel::low);
  bus.run_for(0.3);
  CHECK(int{pose->is_referenced} == 1);
  is_taking_reference = false;
  is_referenced = true;
  bus.run_for(0.3);
  CHECK(poses >= 795);
  CHECK(poses_lost == 0);
  CHECK(reports >= 99);
  CHECK(reports <= 101);
  CHECK(scope_frames > 20);
  CHECK(bus.violations().empty());
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
