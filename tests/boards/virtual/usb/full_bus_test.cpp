// Tests the flashed firmware on an almost full bus: 14 float signals at 20 kHz, poses, and controller reports.
#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <vector>

#include "protocol/scope.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {

TEST_CASE("the longest full selection loses no sample with a slow host that also requests all other reports") {
  constexpr double host_clock_ppm = -500.0;
  FirmwareOnBus bus(flashed_image(), host_clock_ppm);
  bus.connect();
  std::uint32_t scope_frames = 0, lost = 0, dropped = 0;
  std::optional<std::uint32_t> sequence;
  bus.on_scope_frame = [&](std::span<const std::byte> bytes) {
    protocol::ScopeFrameHeader header;
    REQUIRE(bytes.size() >= sizeof header);
    std::memcpy(&header, bytes.data(), sizeof header);
    if (sequence) lost += header.sequence - *sequence - 1;
    sequence = header.sequence;
    dropped = header.samples_dropped;
    ++scope_frames;
  };
  bus.keep_asking_for_poses();
  bus.keep_asking_the_controller();
  std::vector<protocol::Signal> signals;
  for (unsigned i = 0; i < protocol::scope_full_sample_maximum / sizeof(float); ++i)
    signals.push_back(static_cast<protocol::Signal>(i));
  bus.stream_scope(signals);
  bus.run_for(1.0);
  CHECK(scope_frames > 180);
  CHECK(lost == 0);
  CHECK(dropped == 0);
  for (const auto& sentence : bus.violations()) FAIL_CHECK(sentence);
}

}  // namespace inkwell::virtual_usb_test
