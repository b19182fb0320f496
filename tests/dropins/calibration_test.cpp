// Whether the arm knows where it is, as HDAPI asks it, also in faults, in which the board does not tell.
#include <doctest/doctest.h>

#include <device/device.hpp>
#include <dropins/device.hpp>
#include <protocol/reports.hpp>
#include <protocol/supervision.hpp>

#include "held.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::State;

template <class Condition>
protocol::PoseReport read_until(device::Device& arm, Condition condition) {
  for (;;)
    if (const auto pose = arm.read_pose(60s); pose && condition(*pose)) return *pose;
}

TEST_CASE("an arm that a program finds in a fault that comes only with force knows where it is") {
  Board board;
  forget_errors();
  const auto driver = device::Device::open(*board.board.find());
  read_until(*driver, [](const auto& pose) { return pose.state == State::ready; });
  board.hold();
  driver->send(protocol::Command::enable_force);  // and says nothing any more
  const auto pose = read_until(*driver, [](const auto& now) { return now.state == State::fault; });
  REQUIRE(pose.fault == protocol::Fault::host_silent);
  const HHD device = hdInitDevice(nullptr);
  REQUIRE(device == 0);
  CHECK(hdCheckCalibration() == HD_CALIBRATION_OK);
  hdDisableDevice(device);
}

TEST_CASE("an arm that lost counts does not know any more where it is") {
  Held held;
  held.control.inject({.fault = "encoder_slip", .of = "1", .amount = 20'000});
  CHECK(until([] { return hdCheckCalibration() != HD_CALIBRATION_OK; }));
  CHECK(hdCheckCalibration() == HD_CALIBRATION_NEEDS_MANUAL_INPUT);
  held.frame([] {});
  CHECK(says(HD_FORCE_ERROR, "encoder"));
}

TEST_CASE("the faults that come only with force are those of the supervisor's table") {
  for (const auto& row : protocol::watch_table) {
    bool only_with_force = true;
    for (std::size_t i = 0; i < protocol::state_count; ++i) {
      const auto state = static_cast<State>(i);
      if (row.watched_in.contains(state) && !protocol::force_is_on(state)) only_with_force = false;
    }
    CHECK_MESSAGE(dropins::comes_only_with_force(static_cast<int>(row.fault)) == only_with_force,
                  std::string(protocol::info(row.fault).name));
  }
}

}  // namespace
}  // namespace inkwell::tests
