// Poses and controller reports. Each bus frame transfers the newest pose.
#include <doctest/doctest.h>

#include "tests/firmware/usb/host_reads.hpp"

namespace inkwell {

using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::pass_frame;
using test::pass_periods;
using test::poses_dropped;
using test::read_controller;
using test::read_pose;
using test::request;

TEST_CASE("every frame has a pose from near its end, in order and without losses") {
  DeviceBench bench;
  bench.configure();
  std::optional<std::uint32_t> last;
  for (std::uint32_t i = 0; i < 500; ++i) {
    pass_frame(bench);
    const auto pose = read_pose(bench);
    REQUIRE(pose.has_value());
    CHECK(pose->time_periods == bench.periods - 1);
    if (last) CHECK(pose->sequence == *last + 1);
    last = pose->sequence;
    CHECK_FALSE(read_pose(bench).has_value());
  }
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a host that polls late gets the newest pose, and the loss is counted") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  const std::uint32_t first = read_pose(bench)->sequence;
  for (int i = 0; i < 6; ++i) pass_frame(bench);
  const auto pose = read_pose(bench);
  CHECK(pose->sequence == first + 6);
  CHECK(pose->time_periods == bench.periods - 1);
  CHECK_FALSE(read_pose(bench).has_value());
  CHECK(poses_dropped(bench) == 5);
}

TEST_CASE("a host that did not listen for a while has lost nothing") {
  DeviceBench bench;
  bench.configure();
  for (int i = 0; i < 300; ++i) pass_frame(bench);
  CHECK(read_pose(bench).has_value());
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a main loop that is delayed at the end of a frame loses no pose, and the host reads an older pose") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  const std::uint32_t first = read_pose(bench)->sequence;
  pass_periods(bench, 13);
  bench.run(7);  // the main loop does not run
  const auto pose = read_pose(bench);
  REQUIRE(pose.has_value());
  CHECK(pose->sequence == first + 1);
  CHECK(bench.periods - pose->time_periods == 9);
  pass_frame(bench);
  const auto next = read_pose(bench);
  REQUIRE(next.has_value());
  CHECK(next->sequence == first + 2);
  CHECK(next->time_periods == bench.periods - 1);
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a host that reads just before the end of a frame gets no report twice") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  const std::uint32_t first = read_pose(bench)->sequence;
  pass_periods(bench, 17);
  SUBCASE("before the device looks") { CHECK(bench.port.in(1).handshake == Handshake::ack); }
  SUBCASE("as the device is about to replace it") { bench.port.polled_in_cancel = 1; }
  pass_periods(bench, 3);
  CHECK_FALSE(bench.port.polled_in_cancel.has_value());
  CHECK_FALSE(read_pose(bench).has_value());
  pass_frame(bench);
  CHECK(read_pose(bench)->sequence == first + 2);
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a device that is configured again while a spare report waits sends no second report in that frame") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  const std::uint32_t first = read_pose(bench)->sequence;
  pass_periods(bench, 13);  // the host may have read the spare pose while the device was configured
  CHECK(bench.configure() == done_result);
  pass_periods(bench, 7);
  CHECK_FALSE(read_pose(bench).has_value());
  pass_frame(bench);
  CHECK(read_pose(bench)->sequence == first + 2);
}

TEST_CASE("a host that always reads just before the end of a frame still gets the controller reports and the load") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  read_pose(bench);
  std::uint32_t controller_reports = 0, last_sequence = 0;
  for (int frame = 0; frame < 24; ++frame) {
    if (frame == 2) bench.link.poses.note_load(6000);
    pass_periods(bench, 13);
    const auto pose = read_pose(bench);
    REQUIRE(pose.has_value());
    if (frame > 0) CHECK(pose->sequence == last_sequence + 1);
    last_sequence = pose->sequence;
    if (frame == 2) CHECK(int{pose->servo_load} > 100);
    if (frame == 4) CHECK(int{pose->servo_load} < 10);
    if (read_controller(bench)) ++controller_reports;
    pass_periods(bench, 7);
  }
  CHECK(controller_reports > 20);
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("each pose report contains the longest interrupt time since the previous report") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  read_pose(bench);
  for (int i = 0; i < 20; ++i) {
    bench.run(1);
    if (i == 5) bench.link.poses.note_load(6000);
    bench.device.poll();
  }
  CHECK(int{read_pose(bench)->servo_load} == 255 * 6000 / 8400);
  pass_frame(bench);
  CHECK(int{read_pose(bench)->servo_load} == 255 * 100 / 8400);
}

TEST_CASE("nothing is sent while the bus is silent") {
  DeviceBench bench;
  bench.configure();
  bench.port.frames_run = false;
  pass_frame(bench);
  CHECK_FALSE(read_pose(bench).has_value());
  const auto report = bench.get_feature<protocol::FrameReport>(protocol::ReportId::frame);
  const protocol::FrameReport unknown{};
  CHECK(std::memcmp(&report, &unknown, sizeof report) == 0);
}

TEST_CASE("the controller's report is as new as the pose whenever the host's turn has come") {
  DeviceBench bench;
  bench.configure();
  CHECK(bench.port.in(3).handshake == Handshake::nak);
  unsigned cancels = 0;
  for (int i = 0; i < 20; ++i) {
    for (int frame = 0; frame < 8; ++frame) pass_frame(bench);
    const auto report = read_controller(bench);
    REQUIRE(report.has_value());
    // The bench sets x to the period number in meters, which exceeds the range of the report.
    CHECK(report->position[0] == 32767);
    CHECK(report->angle[0] == static_cast<std::int16_t>(bench.periods - 1));
    // Each iteration of eight bus frames replaces the report only once.
    if (i == 0) cancels = bench.port.cancels(0x83);
    CHECK(bench.port.cancels(0x83) == cancels + static_cast<unsigned>(i));
  }
}

TEST_CASE("a host that reads the controller report early gets a report, and a host that never reads it loses no pose") {
  DeviceBench bench;
  bench.configure();
  for (int i = 0; i < 10; ++i) {
    pass_frame(bench);
    REQUIRE(read_pose(bench).has_value());
    CHECK(read_controller(bench).has_value());
    CHECK_FALSE(read_controller(bench).has_value());
  }
  for (int i = 0; i < 300; ++i) {
    pass_frame(bench);
    REQUIRE(read_pose(bench).has_value());
  }
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a sleeping host finds no old report of the controller, and a halt of it leaves the poses alone") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  bench.port.suspend();
  bench.device.poll();
  CHECK_FALSE(read_controller(bench).has_value());
  bench.port.resume();
  pass_frame(bench);
  CHECK(read_controller(bench).has_value());
  CHECK(bench.control(request(0x02, 3, 0, 0x83, 0)) == done_result);
  pass_frame(bench);
  CHECK(bench.port.in(3).handshake == Handshake::stall);
  CHECK(read_pose(bench).has_value());
  CHECK(bench.control(request(0x02, 1, 0, 0x83, 0)) == done_result);
  pass_frame(bench);
  CHECK(read_controller(bench).has_value());
  // A restart of the controller interface does not lose a report that is in progress.
  pass_frame(bench);
  CHECK(bench.control(request(0x01, 11, 0, 2, 0)) == done_result);
  CHECK(read_controller(bench).has_value());
  CHECK(read_pose(bench).has_value());
}

TEST_CASE("the frame report contains the start time of the frame") {
  DeviceBench bench;
  bench.configure();
  for (int i = 0; i < 3; ++i) pass_frame(bench);
  read_pose(bench);
  for (int i = 0; i < 7; ++i) bench.run(1);
  bench.device.poll();
  const auto report = bench.get_feature<protocol::FrameReport>(protocol::ReportId::frame);
  const auto bus_frame = bench.port.bus_frame();
  CHECK(report.is_known == 1);
  CHECK(report.frame_number == bus_frame->number);
  CHECK(report.sequence == bus_frame->count);
  CHECK(report.time_periods * 8400 + report.time_cycles == bus_frame->begin_cycles);
}

}  // namespace inkwell
