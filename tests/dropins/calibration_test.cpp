// Tests HDAPI's calibration check in normal use and during faults.
#include <doctest/doctest.h>

#include "host/client/device/device.hpp"
#include "protocol/reports.hpp"

#include "tests/dropins/held.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::State;

template <class Condition>
device::Pose read_until(device::Device& device, Condition condition) {
  for (;;)
    if (const auto pose = device.read_pose(60s); pose && condition(*pose)) return *pose;
}

TEST_CASE("an arm with a fault that does not affect its encoders is calibrated when a program opens it") {
  Board board;
  forget_errors();
  const auto driver = device::Device::open(*board.board.find());
  read_until(*driver, [](const auto& pose) { return pose.state == State::ready; });
  board.hold();
  driver->send(protocol::Command::enable_force);  // no further commands are sent
  const auto pose = read_until(*driver, [](const auto& now) { return now.state == State::fault; });
  REQUIRE(pose.fault == protocol::Fault::host_silent);
  const HHD device = hdInitDevice(nullptr);
  REQUIRE(device == 0);
  CHECK(hdCheckCalibration() == HD_CALIBRATION_OK);
  hdDisableDevice(device);
}

TEST_CASE("an arm that lost counts is no longer calibrated") {
  Held held;
  held.control.inject({.fault = "encoder_slip", .of = "1", .amount = 20'000});
  CHECK(until([] { return hdCheckCalibration() != HD_CALIBRATION_OK; }));
  CHECK(hdCheckCalibration() == HD_CALIBRATION_NEEDS_MANUAL_INPUT);
  held.frame([] {});
  CHECK(says(HD_FORCE_ERROR, "encoder"));
}

TEST_CASE("an inkwell's switch that is closed elsewhere voids the calibration, and a person has to see to it") {
  Held held;
  held.control.inject({.fault = "wire_low", .of = "inkwell_switch"});
  CHECK(until([] { return hdCheckCalibration() != HD_CALIBRATION_OK; }));
  CHECK(hdCheckCalibration() == HD_CALIBRATION_NEEDS_MANUAL_INPUT);
  held.frame([] {});
  CHECK(says(HD_FORCE_ERROR, "inkwell"));
}

}  // namespace
}  // namespace inkwell::tests
