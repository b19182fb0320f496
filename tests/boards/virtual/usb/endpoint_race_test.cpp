// What the host does between a read and a write of the driver, where neither knows of the other.
#include <doctest/doctest.h>

#include <array>

#include "firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {

TEST_CASE("a pose that the host takes while the driver takes it back does not begin again") {
  for (const int token_at : {1, 2, 3}) {
    CAPTURE(token_at);
    FirmwareOnBus bus(flashed_image(INKWELL_BUILD_DIRECTORY));
    bus.connect();
    bus.run_for(0.01);
    constexpr std::uint32_t control_of_poses = 0x920, epena = 1u << 31;
    constexpr unsigned address = 2, pose_endpoint = 1;
    std::array<std::byte, virtual_board::full_speed_packet_maximum> packet;
    int reads = 0;
    bool taken = false;
    // The driver reads the register when it replaces a pose that is still there, and once more to change it.
    bus.registers.on_read = [&](std::uint32_t offset, std::uint32_t value) {
      if (offset != control_of_poses || (value & epena) == 0) return;
      ++reads;
      if (reads == token_at) bus.core.in(address, pose_endpoint, packet);
      if (reads == token_at + 1) taken = bus.core.finish_in(pose_endpoint);
    };
    bus.run_for(0.005);
    CHECK(taken == (token_at == 1));
    for (const auto& sentence : bus.violations()) FAIL_CHECK(sentence);

    bus.registers.on_read = {};
    bus.keep_asking_for_poses();
    int poses = 0;
    bus.cable.on_finished_in = [&](unsigned endpoint, bool done) {
      poses += endpoint == pose_endpoint && done ? 1 : 0;
    };
    bus.run_for(0.02);
    CHECK(poses >= 18);
  }
}

}  // namespace inkwell::virtual_usb_test
