#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "firmware/usb/controller_report.hpp"

namespace {

using namespace inkwell;

protocol::PoseReport example_pose() {
  protocol::PoseReport pose{};
  pose.is_referenced = 1;
  return pose;
}

TEST_CASE("the controller counts hundredths of a millimetre and tenths of a milliradian, to the nearest") {
  auto pose = example_pose();
  const float position_m[] = {0.123456f, -0.000004f, -0.1f}, gimbal_rad[] = {1.00006f, -0.5f, 0.00004f};
  std::copy_n(position_m, 3, pose.position_m);
  std::copy_n(gimbal_rad, 3, pose.gimbal_rad);
  const auto report = usb::controller_report(pose);
  CHECK(report.position[0] == 12346);
  CHECK(report.position[1] == 0);
  CHECK(report.position[2] == -10000);
  CHECK(report.angle[0] == 10001);
  CHECK(report.angle[1] == -5000);
  CHECK(report.angle[2] == 0);
}

TEST_CASE("positions outside the range of the report, infinities and NaN become limits of the range") {
  auto pose = example_pose();
  pose.position_m[0] = 1.0f;
  pose.position_m[1] = -std::numeric_limits<float>::infinity();
  pose.position_m[2] = std::numeric_limits<float>::quiet_NaN();
  const auto report = usb::controller_report(pose);
  CHECK(report.position[0] == 32767);
  CHECK(report.position[1] == -32767);
  CHECK(report.position[2] == 32767);
}

TEST_CASE("without a reference, the position axes are in their middle and the gimbal axes are measured") {
  auto pose = example_pose();
  pose.position_m[1] = 0.05f;
  pose.gimbal_rad[1] = 0.2f;
  CHECK(usb::controller_report(pose).position[1] == 5000);
  pose.is_referenced = 0;
  const auto report = usb::controller_report(pose);
  for (const auto each : report.position) CHECK(each == 0);
  CHECK(report.angle[1] == 2000);
}

TEST_CASE("of the switches it has the two buttons, not the inkwell") {
  protocol::PoseReport pose{};
  for (unsigned switches = 0; switches < 8; ++switches) {
    pose.switches = switches & 7;
    CHECK(usb::controller_report(pose).buttons == (switches & 3));
  }
}

}  // namespace
