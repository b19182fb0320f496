// Selection of signals, and scope frames as the host reads them.
#pragma once

#include <doctest/doctest.h>

#include <cstring>

#include "tests/firmware/usb/host_reads.hpp"

namespace inkwell::test {

inline void select_scope(DeviceBench& bench, std::uint8_t count, std::uint8_t token) {
  protocol::CommandReport report = command(protocol::Command::select_signals, token);
  report.selection.count = count;
  for (std::uint8_t i = 0; i < count; ++i) report.selection.signals[i] = i;
  REQUIRE(bench.port.out(1, bytes_of(report)) == Handshake::ack);
  bench.device.poll();
}

/// Reads one bulk transfer, up to a short or empty packet.
inline Bytes read_frame(DeviceBench& bench) {
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

inline protocol::ScopeFrameHeader header_of(const Bytes& frame) {
  protocol::ScopeFrameHeader header;
  REQUIRE(frame.size() >= sizeof header);
  std::memcpy(&header, frame.data(), sizeof header);
  CHECK(header.magic == protocol::scope_magic);
  CHECK(header.length == frame.size());
  return header;
}

}  // namespace inkwell::test
