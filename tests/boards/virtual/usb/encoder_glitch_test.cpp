// Tests how spikes on an encoder wire change the pose. Crosstalk from the bridges causes spikes on encoder wires.
#include <doctest/doctest.h>

#include <functional>
#include <set>

#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

/// Applies spikes of this length and period to an encoder wire, and returns the angles of joint 1 from the poses.
std::set<float> angles_under_spikes(board::Pin wire, double spike_s, double period_s) {
  FirmwareOnBus bus(flashed_image());
  for (const auto& input : {board::omni_driver.encoders[0].a.pin, board::omni_driver.encoders[0].b.pin})
    bus.chip.input_pins().drive(input.port, input.number, virtual_board::PinLevel::low);
  bus.connect();
  bus.run_for(0.01);
  std::set<float> angles;
  bus.on_pose = [&](const protocol::PoseReport& pose) { angles.insert(pose.joint_rad[0]); };
  auto& scheduler = bus.chip.connections().scheduler;
  const std::function<void()> spikes = [&] {
    bus.chip.glitch(wire.port, wire.number, ticks(spike_s));
    scheduler.at(scheduler.now() + ticks(period_s), spikes);
  };
  spikes();
  bus.keep_asking_for_poses();
  bus.run_for(0.1);
  CHECK(bus.violations().empty());
  return angles;
}

}  // namespace

// The spike periods have no common factor with the control period, so that spikes occur at every phase.
TEST_CASE("spikes of 100 ns on an encoder's wire leave the pose alone, longer ones move it by a count") {
  for (const board::Pin wire : {board::omni_driver.encoders[0].a.pin, board::omni_driver.encoders[0].b.pin}) {
    CAPTURE(wire.number);
    CHECK(angles_under_spikes(wire, 100e-9, 207e-9).size() == 1);
    CHECK(angles_under_spikes(wire, 330e-9, 700e-9).size() == 1);
    // Half of the time, the encoder count is wrong by one. The firmware counts up and down once per spike.
    CHECK(angles_under_spikes(wire, 1e-6, 2.03e-6).size() == 2);
  }
}

}  // namespace inkwell::virtual_usb_test
