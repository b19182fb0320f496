// Poses are synchronized to the bus for every phase between host clock and control period.
#include <doctest/doctest.h>

#include <cstring>
#include <optional>

#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"
#include "tests/boards/virtual/usb/pose_timing.hpp"

namespace inkwell::virtual_usb_test {

TEST_CASE("every frame of a fast and of a slow host brings a new pose, and none is old") {
  // The clocks drift by more than half a millisecond, so that every phase between control period and frame occurs.
  for (const double host_clock_ppm : {500.0, -500.0}) {
    CAPTURE(host_clock_ppm);
    const PoseTiming timing = measure_poses(flashed_image(), host_clock_ppm, 1.5, 14);
    CHECK(timing.frames >= 1498);
    CHECK(timing.empty_frames == 0);
    CHECK(timing.gaps == 0);
    CHECK(timing.edges > 900);
    CHECK(timing.longest_edge_to_token < board::processor_Hz / 1'000'000 * 1'100);
    CHECK(timing.longest_pause_periods <= 21);
  }
}

TEST_CASE("every frame has a new pose while all parameters are set repeatedly") {
  for (const double host_clock_ppm : {500.0, -500.0}) {
    CAPTURE(host_clock_ppm);
    const PoseTiming timing = measure_poses(flashed_image(), host_clock_ppm, 3.0, 3, Beside::storm_of_parameters);
    CHECK(timing.frames >= 2996);
    CHECK(timing.empty_frames == 0);
    CHECK(timing.gaps == 0);
  }
}

TEST_CASE("the frame report shows the start of a bus frame and the difference between the clock rates") {
  constexpr double host_clock_ppm = 200.0;
  FirmwareOnBus bus(flashed_image(), host_clock_ppm);
  bus.connect();
  struct Seen {
    std::uint16_t number = 0;
    Ticks when = 0;
  };
  Seen newest;
  bus.cable.on_start_of_frame = [&](std::uint16_t number) { newest = {number, bus.chip.now()}; };
  const auto read = [&] {
    const auto answer = bus.control(0xA1, 1, 0x0300 | static_cast<std::uint16_t>(protocol::ReportId::frame), 0,
                                    sizeof(protocol::FrameReport));
    REQUIRE(answer.data.size() == sizeof(protocol::FrameReport));
    protocol::FrameReport report;
    std::memcpy(&report, answer.data.data(), sizeof report);
    return report;
  };
  const auto cycles = [](const protocol::FrameReport& report) {
    return static_cast<double>(report.time_periods) * board::servo_cycles + report.time_cycles;
  };
  const auto first = read();
  CHECK(((newest.number - first.frame_number) & 2047) <= 2);
  CHECK(first.time_cycles < board::servo_cycles);
  bus.run_for(1.0);
  const auto second = read();
  const std::uint32_t frames = second.sequence - first.sequence;
  CHECK(frames > 990);
  CHECK(((second.frame_number - first.frame_number) & 2047) == (frames & 2047));
  const double cycles_per_frame = (cycles(second) - cycles(first)) / frames;
  CHECK((board::processor_Hz / 1000.0 / cycles_per_frame - 1.0) * 1e6 ==
        doctest::Approx(host_clock_ppm).epsilon(0.002));
}

TEST_CASE("a pose that the host left is replaced by a newer one") {
  FirmwareOnBus bus(flashed_image());
  bus.connect();
  std::optional<protocol::PoseReport> pose;
  Ticks taken_at = 0;
  bus.cable.on_in = [&](unsigned endpoint, const virtual_board::InReply& reply, std::span<const std::byte> data) {
    if (endpoint != 1 || reply.handshake != virtual_board::Handshake::ack) return;
    REQUIRE(data.size() == sizeof(protocol::PoseReport));
    if (pose) return;  // only the first pose is used
    std::memcpy(&pose.emplace(), data.data(), sizeof *pose);
    taken_at = bus.chip.now();
  };
  bus.run_for(0.05);  // no requests
  bus.keep_asking_for_poses();
  bus.run_for(0.0015);
  REQUIRE(pose.has_value());
  const auto first = *pose;
  const Ticks first_at = taken_at;
  bus.stop_asking_for_poses();
  bus.run_for(0.02);
  pose.reset();
  bus.keep_asking_for_poses();
  bus.run_for(0.0015);
  REQUIRE(pose.has_value());
  // The pose belongs to the most recent bus frame.
  CHECK(pose->sequence - first.sequence == (taken_at - first_at + ticks(0.0005)) / ticks(0.001));
  CHECK(pose->time_periods - first.time_periods ==
        doctest::Approx((pose->sequence - first.sequence) * 20.0).epsilon(0.005));
}

}  // namespace inkwell::virtual_usb_test
