// Poses, scope frames, and a host that sleeps, vanishes or comes back.
#include <doctest/doctest.h>

#include <cstring>

#include "device_bench.hpp"

namespace inkwell {

using protocol::PoseReport;
using test::Bytes;
using test::bytes_of;
using test::command;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::InPacket;
using test::request;

namespace {

std::optional<PoseReport> read_pose(DeviceBench& bench) {
  const InPacket packet = bench.port.in(1);
  if (packet.handshake != Handshake::ack) return std::nullopt;
  REQUIRE(packet.data.size() == sizeof(PoseReport));
  PoseReport pose;
  std::memcpy(&pose, packet.data.data(), sizeof pose);
  bench.device.poll();
  return pose;
}

std::optional<protocol::ControllerReport> read_controller(DeviceBench& bench) {
  const InPacket packet = bench.port.in(3);
  if (packet.handshake != Handshake::ack) return std::nullopt;
  REQUIRE(packet.data.size() == 14);
  protocol::ControllerReport report;
  std::memcpy(&report, packet.data.data(), sizeof report);
  bench.device.poll();
  return report;
}

void select_scope(DeviceBench& bench, std::uint8_t count, std::uint8_t token) {
  protocol::CommandReport report = command(protocol::Command::select_signals, token);
  report.selection.count = count;
  for (std::uint8_t i = 0; i < count; ++i) report.selection.signals[i] = i;
  REQUIRE(bench.port.out(1, bytes_of(report)) == Handshake::ack);
  bench.device.poll();
}

/// One bulk transfer as a host reads it: packets up to a short or empty one.
Bytes read_frame(DeviceBench& bench) {
  Bytes frame;
  frame.reserve(protocol::scope_frame_maximum);  // grown bit by bit it would need twice the room on the target
  for (std::size_t i = 0; i <= protocol::scope_frame_maximum / usb::packet_size_maximum; ++i) {
    const InPacket packet = bench.port.in(2);
    if (packet.handshake != Handshake::ack) {
      CHECK(frame.empty());  // a frame never pauses: what was given to the port is whole
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

/// A frame of the bus as the main loop sees it: it looks after every control period.
void pass_frame(DeviceBench& bench) {
  for (int i = 0; i < 20; ++i) {
    bench.run(1);
    bench.device.poll();
  }
}

std::uint32_t poses_dropped(DeviceBench& bench) {
  return bench.get_feature<protocol::InformationReport>(protocol::ReportId::information).pose_reports_dropped;
}

}  // namespace

TEST_CASE("a pose comes in every frame, taken near its end, in order, none lost") {
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

TEST_CASE("a main loop that is held up at a frame's end costs no pose: the host finds an older one") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  const std::uint32_t first = read_pose(bench)->sequence;
  for (int i = 0; i < 13; ++i) {
    bench.run(1);
    bench.device.poll();
  }
  bench.run(7);  // and nobody looks
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

TEST_CASE("a host that asks just before a frame's end gets no report twice") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  const std::uint32_t first = read_pose(bench)->sequence;
  for (int i = 0; i < 17; ++i) {
    bench.run(1);
    bench.device.poll();
  }
  SUBCASE("before the device looks") { CHECK(bench.port.in(1).handshake == Handshake::ack); }
  SUBCASE("as the device is about to replace it") { bench.port.asked_in_cancel = 1; }
  for (int i = 0; i < 3; ++i) {
    bench.run(1);
    bench.device.poll();
  }
  CHECK(bench.port.asked_in_cancel == 0);
  CHECK_FALSE(read_pose(bench).has_value());
  pass_frame(bench);
  CHECK(read_pose(bench)->sequence == first + 2);
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a host that always asks just before a frame's end has the controller's reports and the load all the same") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  read_pose(bench);
  std::uint32_t controller_reports = 0, last_sequence = 0;
  const auto pass = [&](int periods) {
    for (int i = 0; i < periods; ++i) {
      bench.run(1);
      bench.device.poll();
    }
  };
  for (int frame = 0; frame < 24; ++frame) {
    if (frame == 2) bench.link.poses.note_load(6000);
    pass(13);
    const auto pose = read_pose(bench);
    REQUIRE(pose.has_value());
    if (frame > 0) CHECK(pose->sequence == last_sequence + 1);
    last_sequence = pose->sequence;
    if (frame == 2) CHECK(int{pose->servo_load} > 100);
    if (frame == 4) CHECK(int{pose->servo_load} < 10);
    if (read_controller(bench)) ++controller_reports;
    pass(7);
  }
  CHECK(controller_reports > 20);
  CHECK(poses_dropped(bench) == 0);
}

TEST_CASE("a report tells the longest interrupt since the one before, whatever was made ready in between") {
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
  CHECK(bench.get_report(3, static_cast<std::uint8_t>(protocol::ReportId::frame), 16) == test::stall_result);
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
    // The bench's x is the number of the period, in metres: far beyond the range.
    CHECK(report->position[0] == 32767);
    CHECK(report->angle[0] == static_cast<std::int16_t>(bench.periods - 1));
    // Which takes one replacement after the first time, not one in each frame.
    if (i == 0) cancels = bench.port.cancels(0x83);
    CHECK(bench.port.cancels(0x83) == cancels + static_cast<unsigned>(i));
  }
}

TEST_CASE("a host that asks the controller early gets a report as well, and one that never asks loses no pose") {
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
  // Its interface by itself starts again; a report that was under way stays whole.
  pass_frame(bench);
  CHECK(bench.control(request(0x01, 11, 0, 2, 0)) == done_result);
  CHECK(read_controller(bench).has_value());
  CHECK(read_pose(bench).has_value());
}

TEST_CASE("the frame report says when the frame began") {
  DeviceBench bench;
  bench.configure();
  for (int i = 0; i < 3; ++i) pass_frame(bench);
  read_pose(bench);
  for (int i = 0; i < 7; ++i) bench.run(1);
  bench.device.poll();
  const auto report = bench.get_feature<protocol::FrameReport>(protocol::ReportId::frame);
  const auto frame = bench.port.frame();
  CHECK(report.frame_number == frame->number);
  CHECK(report.sequence == frame->count);
  CHECK(report.time_periods * 8400 + report.time_cycles == frame->begin_cycles);
}

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
    const Bytes frame = read_frame(bench);  // read_frame goes on to a packet shorter than 64
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
  // Every sample was either read or counted as dropped.
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
  SUBCASE("its interface set anew") { CHECK(bench.control(request(0x01, 11, 0, 1, 0)) == done_result); }
  SUBCASE("the device configured anew") { CHECK(bench.configure() == done_result); }

  CHECK_FALSE(bench.port.data_toggle(0x82));
  CHECK(header_of(read_frame(bench)).sequence == 0);
  CHECK(header_of(read_frame(bench)).sequence == 1);
}

TEST_CASE("a halted pose endpoint sends the report that was on its way again") {
  DeviceBench bench;
  bench.configure();
  pass_frame(bench);
  CHECK(bench.control(request(0x02, 1, 0, 0x81, 0)) == done_result);
  CHECK(read_pose(bench)->time_periods == bench.periods - 1);
}

TEST_CASE("suspend switches the force and the scope off, and resume goes on with fresh poses") {
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
  CHECK(bench.link.scope.samples_dropped() == 0);  // it stopped
  bench.device.poll();

  bench.port.resume();
  bench.device.poll();
  CHECK_FALSE(bench.device.suspended());
  CHECK_FALSE(read_pose(bench).has_value());  // what was on its way is out of date
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
    bench.port.suspend();  // without VBUS sensing, that is all a device sees of it
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
    // At most the two frames that were handed over before come first; their token tells.
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
