// Tests how the flashed firmware reacts to VBUS (USB 2.0, section 7.1.5).
#include <doctest/doctest.h>

#include <array>
#include <span>

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

bool enumerates(FirmwareOnBus& bus) {
  for (int i = 0; i < 1000 && !bus.port.enumerated(); ++i) bus.run_for(0.001);
  return bus.port.enumerated();
}

}  // namespace

TEST_CASE("D+ is pulled up only while the cable brings VBUS") {
  FirmwareOnBus bus(flashed_image());
  bus.connect();
  bus.plug(false);
  bus.run_for(0.001);
  CHECK(bus.core.attachment() == 0);
  bus.run_for(0.05);
  CHECK(bus.core.attachment() == 0);
  bus.plug(true);
  CHECK(enumerates(bus));

  bus.plug(false);
  bus.chip.reset();
  bus.run_for(0.2);
  CHECK(bus.core.attachment() == 0);
  bus.plug(true);
  CHECK(enumerates(bus));
  CHECK(bus.violations().empty());
}

TEST_CASE("a bus that falls asleep with the cable in stops the scope, and poses come again when it wakes") {
  FirmwareOnBus bus(flashed_image());
  bus.connect();
  int scope_frames = 0, poses = 0;
  bus.on_scope_frame = [&](std::span<const std::byte>) { ++scope_frames; };
  bus.on_pose = [&](const protocol::PoseReport&) { ++poses; };
  bus.keep_asking_for_poses();
  bus.stream_scope(std::array{protocol::Signal::position_x_m});
  bus.run_for(0.05);
  CHECK(scope_frames > 5);
  bus.core.suspend();  // the next start of frame resumes the bus
  bus.run_for(0.02);   // packets in progress may still arrive
  scope_frames = poses = 0;
  bus.run_for(0.05);
  CHECK(scope_frames == 0);
  CHECK(poses >= 48);
  CHECK(bus.violations().empty());
}

}  // namespace inkwell::virtual_usb_test
