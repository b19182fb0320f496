// Tests scope frames, and hosts that suspend, disappear or return.
#include <doctest/doctest.h>

#include <cstring>

#include "tests/firmware/usb/host_reads.hpp"

namespace inkwell {

using protocol::PoseReport;
using test::Bytes;
using test::bytes_of;
using test::command;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::InPacket;
using test::pass_frame;
using test::read_pose;
using test::request;

namespace {

void select_scope(DeviceBench& bench, std::uint8_t count, std::uint8_t token) {
  protocol::CommandReport report = command(protocol::Command::select_signals, token);
  report.selection.count = count;
  for (std::uint8_t i = 0; i < count; ++i) report.selection.signals[i] = i;
  REQUIRE(bench.port.out(1, bytes_of(report)) == Handshake::ack);
  bench.device.poll();
}

/// Reads one bulk transfer, up to a short or empty packet.
Bytes read_frame(DeviceBench& bench) {
  Bytes frame;
  frame.reserve(protocol::scope_frame_maximum);  // growth without reserve() would need twice the memory on the target
  for (std::size_t i = 0; i <= protocol::scope_frame_maximum / usb::packet_size_maximum; ++i) {
    const InPacket packet = bench.port.in(2);
    if (packet.handshake != Handshake::ack) {
      CHECK(frame.empty());  // the device never pauses within a frame, because the port has the complete frame
      return {};
    }
    frame.insert(frame.end(), packet.data.begin(), packet.data.end());
    bench.device.poll();
    if (packet.data.size() < 64) return frame;
  }
  FAIL("a frame without an end");
  return {};
}

protocol::ScopeFrameHeader header_of(const Bytes& frame) {
  protocol::ScopeFrameHeader header;
  REQUIRE(frame.size() >= sizeof header);
  std::memcpy(&header, frame.data(), sizeof header);
  CHECK(header.magic == protocol::scope_magic);
  CHECK(header.length == frame.size());
  return header;
}

bool force_goes_off(DeviceBench& bench) {
  bench.last_command.reset();
  bench.run(1);
  return bench.last_command && bench.last_command->command == protocol::Command::stop;
}

}  // namespace

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

TEST_CASE("suspend switches the force and the scope off, and new poses follow the resume") {
  DeviceBench bench;
  bench.configure();
  select_scope(bench, 14, 1);
  bench.run(200);
  bench.device.poll();
  bench.port.out(1, bytes_of(command(protocol::Command::enable_force, 2)));
  bench.port.suspend();
  bench.device.poll();
  CHECK(bench.device.suspended());
  CHECK(force_goes_off(bench));
  CHECK_FALSE(bench.link.commands.take_sign_of_life());
  bench.run(1000);
  CHECK(bench.link.scope.samples_dropped() == 0);  // the scope is off
  bench.device.poll();

  bench.port.resume();
  bench.device.poll();
  CHECK_FALSE(bench.device.suspended());
  CHECK_FALSE(read_pose(bench).has_value());  // the pose from before the suspend is canceled
  pass_frame(bench);
  const auto pose = read_pose(bench);
  REQUIRE(pose.has_value());
  CHECK(pose->time_periods >= bench.periods - 2);
}

TEST_CASE("reset and configuration 0 switch the force off") {
  DeviceBench bench;
  bench.configure();
  bench.run(1);
  SUBCASE("reset") { bench.port.reset(); }
  SUBCASE("configuration 0") { CHECK(bench.configure(0) == done_result); }
  bench.device.poll();
  CHECK(force_goes_off(bench));
}

TEST_CASE("unplugged and plugged in again in every state, the device works as the first time") {
  for (int state = 0; state < 7; ++state) {
    CAPTURE(state);
    DeviceBench bench;
    if (state >= 1) bench.control(request(0x00, 5, 9, 0, 0));
    if (state >= 2) bench.configure();
    if (state >= 3) {
      bench.run(20);
      bench.device.poll();
    }
    if (state >= 4) {
      select_scope(bench, 14, 1);
      bench.run(100);
      bench.device.poll();
      for (int i = 0; i < 7; ++i) bench.port.in(2);
    }
    if (state >= 5) bench.setup(request(0xA1, 1, 0x0311, 0, 4096));
    if (state >= 6) bench.port.in(0);
    bench.port.suspend();  // without VBUS sensing, the device sees an unplugged cable as a suspend
    bench.device.poll();
    bench.run(500);
    bench.device.poll();
    bench.port.reset();
    bench.device.poll();
    CHECK_FALSE(bench.device.configured());
    CHECK(bench.get_descriptor(0x0100, 64).data.size() == 18);
    bench.port.reset();
    bench.device.poll();
    CHECK(bench.control(request(0x00, 5, 10, 0, 0)) == done_result);
    CHECK(bench.configure() == done_result);
    select_scope(bench, 14, 77);
    bench.run(200);
    bench.device.poll();
    CHECK(read_pose(bench).has_value());
    // Up to two old frames arrive before the new frames. A frame's token identifies its signal selection.
    int old_frames = 0;
    auto header = header_of(read_frame(bench));
    for (; header.selection_token != 77; header = header_of(read_frame(bench))) {
      ++old_frames;
      bench.run(1);
      bench.device.poll();
    }
    CHECK(old_frames <= 2);
    CHECK(header.sequence == 0);
  }
}

}  // namespace inkwell
