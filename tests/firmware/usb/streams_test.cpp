// Tests scope frames.
#include <doctest/doctest.h>

#include "tests/firmware/usb/scope_frames.hpp"

namespace inkwell {

using test::Bytes;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::header_of;
using test::pass_frame;
using test::read_frame;
using test::read_pose;
using test::request;
using test::select_scope;

TEST_CASE("scope frames come whole and in order") {
  DeviceBench bench;
  bench.configure();
  select_scope(bench, 14, 21);
  std::uint32_t sequence = 0, next_period = bench.periods;
  for (int i = 0; i < 400; ++i) {
    bench.run(20);
    bench.device.poll();
    for (Bytes frame = read_frame(bench); !frame.empty(); frame = read_frame(bench)) {
      const auto header = header_of(frame);
      CHECK(header.sequence == sequence++);
      CHECK(header.first_period == next_period);
      CHECK(header.selection_token == 21);
      next_period += header.sample_count;
      bench.run(1);
      bench.device.poll();
    }
  }
  CHECK(sequence > 50);
  CHECK(bench.link.scope.samples_dropped() == 0);
  CHECK(bench.link.commands.last_token() == 21);
}

TEST_CASE("a frame that is a multiple of 64 ends with an empty packet") {
  DeviceBench bench;
  bench.configure();
  select_scope(bench, 2, 1);  // 24 + 109 * 8 = 14 * 64
  bench.run(600);
  bench.device.poll();
  for (int i = 0; i < 2; ++i) {
    const Bytes frame = read_frame(bench);  // read_frame() continues until a packet is shorter than 64 bytes
    CHECK(frame.size() == 14 * 64);
    CHECK(header_of(frame).sequence == static_cast<std::uint32_t>(i));
  }
}

TEST_CASE("the next frame is at hand when one was sent, without waiting for the interrupt") {
  DeviceBench bench;
  bench.configure();
  select_scope(bench, 14, 1);
  bench.run(2 * protocol::scope_frame_samples_maximum);
  bench.device.poll();
  CHECK(!read_frame(bench).empty());
  CHECK(!read_frame(bench).empty());
}

TEST_CASE("a host that stops reading costs samples, which are counted, and nothing else") {
  DeviceBench bench;
  bench.configure();
  select_scope(bench, 14, 1);
  const std::uint32_t start = bench.periods;
  for (int i = 0; i < 500; ++i) {
    bench.run(20);
    bench.device.poll();
    REQUIRE(read_pose(bench).has_value());
  }
  const auto information = bench.get_feature<protocol::InformationReport>(protocol::ReportId::information);
  CHECK(information.scope_samples_dropped > 8000);
  CHECK(information.pose_reports_dropped == 0);
  std::uint32_t samples = 0, last_end = 0;
  for (Bytes frame = read_frame(bench); !frame.empty(); frame = read_frame(bench)) {
    const auto header = header_of(frame);
    samples += header.sample_count;
    last_end = header.first_period + header.sample_count;
    bench.run(1);
    bench.device.poll();
  }
  // Every sample was read or counted as dropped.
  CHECK(samples + bench.link.scope.samples_dropped() == last_end - start);
}

TEST_CASE("a halted scope endpoint starts the frame again from its first byte") {
  DeviceBench bench;
  bench.configure();
  select_scope(bench, 14, 1);
  bench.run(2 * protocol::scope_frame_samples_maximum);
  bench.device.poll();
  const auto clear = request(0x02, 1, 0, 0x82, 0), halt = request(0x02, 3, 0, 0x82, 0);
  for (int i = 0; i < 5; ++i) CHECK(bench.port.in(2).handshake == Handshake::ack);

  SUBCASE("halted and cleared") {
    CHECK(bench.control(halt) == done_result);
    CHECK(bench.port.in(2).handshake == Handshake::stall);
    CHECK(bench.control(clear) == done_result);
  }
  SUBCASE("cleared while it was running") { CHECK(bench.control(clear) == done_result); }
  SUBCASE("the interface is set again") { CHECK(bench.control(request(0x01, 11, 0, 1, 0)) == done_result); }
  SUBCASE("the device is configured again") { CHECK(bench.configure() == done_result); }

  CHECK_FALSE(bench.port.data_toggle(0x82));
  CHECK(header_of(read_frame(bench)).sequence == 0);
  CHECK(header_of(read_frame(bench)).sequence == 1);
}

TEST_CASE("a halted pose endpoint sends the pending report again") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  CHECK(bench.control(request(0x02, 1, 0, 0x81, 0)) == done_result);
  CHECK(read_pose(bench)->time_periods == bench.periods - 1);
}

}  // namespace inkwell
