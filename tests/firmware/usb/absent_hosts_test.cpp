// Tests hosts that suspend, disappear or return.
#include <doctest/doctest.h>

#include "tests/firmware/usb/scope_frames.hpp"

namespace inkwell {

using test::bytes_of;
using test::command;
using test::DeviceBench;
using test::done_result;
using test::header_of;
using test::pass_frame;
using test::read_frame;
using test::read_pose;
using test::request;
using test::select_scope;

namespace {

bool force_goes_off(DeviceBench& bench) {
  bench.last_command.reset();
  bench.run(1);
  return bench.last_command && bench.last_command->command == protocol::Command::stop;
}

}  // namespace

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
