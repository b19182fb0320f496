// Tests the flashed firmware with a continuously moving gimbal.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "protocol/scope.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {

TEST_CASE("each turn of a gimbal potentiometer uses a new measurement") {
  using protocol::Signal;
  FirmwareOnBus bus(flashed_image());
  // The gimbal angle changes by about seven converter steps between two samples.
  bus.circuit.voltage_V = [](char, unsigned, Ticks now) {
    constexpr double ramp_s = 0.05;
    return 0.5 + 2.0 * std::fmod(virtual_board::seconds(now), ramp_s) / ramp_s;
  };
  std::vector<std::array<float, 3>> samples;
  bus.on_scope_frame = [&](std::span<const std::byte> bytes) {
    protocol::ScopeFrameHeader header;
    REQUIRE(bytes.size() >= sizeof header);
    std::memcpy(&header, bytes.data(), sizeof header);
    REQUIRE(bytes.size() == sizeof header + header.sample_count * sizeof(samples[0]));
    const std::size_t before = samples.size();
    samples.resize(before + header.sample_count);
    std::memcpy(&samples[before], bytes.data() + sizeof header, bytes.size() - sizeof header);
  };
  bus.connect();
  bus.stream_scope(std::array{Signal::gimbal_1_rad, Signal::gimbal_2_rad, Signal::gimbal_3_rad});
  bus.run_for(0.2);
  REQUIRE(samples.size() > 3'000);
  for (std::size_t i = 3; i < samples.size(); ++i) {
    CAPTURE(i);
    for (std::size_t axis = 0; axis < 3; ++axis) REQUIRE(samples[i][axis] != samples[i - 3][axis]);
  }
}

}  // namespace inkwell::virtual_usb_test
