// Reads poses and controller reports from the device of a test bench.
#pragma once

#include <cstring>
#include <optional>

#include <doctest/doctest.h>

#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell::test {

inline std::optional<protocol::PoseReport> read_pose(DeviceBench& bench) {
  const InPacket packet = bench.port.in(1);
  if (packet.handshake != Handshake::ack) return std::nullopt;
  REQUIRE(packet.data.size() == sizeof(protocol::PoseReport));
  protocol::PoseReport pose;
  std::memcpy(&pose, packet.data.data(), sizeof pose);
  bench.device.poll();
  return pose;
}

inline std::optional<protocol::ControllerReport> read_controller(DeviceBench& bench) {
  const InPacket packet = bench.port.in(3);
  if (packet.handshake != Handshake::ack) return std::nullopt;
  REQUIRE(packet.data.size() == 14);
  protocol::ControllerReport report;
  std::memcpy(&report, packet.data.data(), sizeof report);
  bench.device.poll();
  return report;
}

/// Runs the main loop once after each control period.
inline void pass_periods(DeviceBench& bench, int periods) {
  for (int i = 0; i < periods; ++i) {
    bench.run(1);
    bench.device.poll();
  }
}
/// Passes one bus frame.
inline void pass_frame(DeviceBench& bench) { pass_periods(bench, 20); }

inline std::uint32_t poses_dropped(DeviceBench& bench) {
  return bench.get_feature<protocol::InformationReport>(protocol::ReportId::information).pose_reports_dropped;
}

}  // namespace inkwell::test
