// A device on a fake port. The host performs control transfers.
#pragma once

#include <cstring>
#include <initializer_list>

#include "firmware/usb/device.hpp"
#include "protocol/driver.hpp"

#include "tests/firmware/link/fresh_link.hpp"
#include "tests/firmware/usb/fake_port.hpp"

namespace inkwell::test {

inline usb::SetupPacket request(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::uint16_t index,
                                std::uint16_t length) {
  return {type, request, value, index, length};
}

inline constexpr usb::Identity identity{{'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'A', 'B',
                                         'C', 'D', 'E', 'F', '0', '1', '2', '3', '4', '5', '6', '7'},
                                        {1, 2, 3},
                                        "trial_board",
                                        168'000'000,
                                        0x14,
                                        0x600DC0DE};

/// Result of a control transfer and the data of its IN data stage.
struct ControlResult {
  bool stalled = false;
  Bytes data{};
  bool operator==(const ControlResult&) const = default;
};

inline const ControlResult stall_result{true, {}};
inline const ControlResult done_result{false, {}};

inline ControlResult answer(std::initializer_list<int> bytes) {
  ControlResult result;
  for (const int byte : bytes) result.data.push_back(static_cast<std::byte>(byte));
  return result;
}

struct DeviceBench {
  FakePort port;
  std::uint32_t periods;  ///< number of the next control period
  link::Link& link = fresh_link(periods);
  usb::Device device{port, link, identity};

  explicit DeviceBench(std::uint32_t first_period = 0) : periods(first_period) {
    port.reset();
    device.poll();
  }

  void setup(const usb::SetupPacket& packet) {
    port.setup(std::as_bytes(std::span(&packet, 1)));
    device.poll();
  }

  /// Performs the IN data stage and the status stage of the request that setup() sent.
  ControlResult read(std::uint16_t length) {
    ControlResult result;
    for (;;) {
      const InPacket packet = port.in(0);
      if (packet.handshake == Handshake::stall) return stall_result;
      REQUIRE(packet.handshake == Handshake::ack);
      result.data.insert(result.data.end(), packet.data.begin(), packet.data.end());
      device.poll();
      REQUIRE(result.data.size() <= length);
      if (packet.data.size() < 64 || result.data.size() == length) break;
    }
    // The device sends no more data and accepts the status stage.
    CHECK(port.in(0).handshake == Handshake::nak);
    CHECK(port.out(0, {}) == Handshake::ack);
    device.poll();
    return result;
  }

  ControlResult status_in() {
    const InPacket packet = port.in(0);
    if (packet.handshake == Handshake::stall) return stall_result;
    REQUIRE(packet.handshake == Handshake::ack);
    CHECK(packet.data.empty());
    device.poll();
    CHECK(port.in(0).handshake == Handshake::nak);
    return done_result;
  }

  ControlResult control(const usb::SetupPacket& packet, std::span<const std::byte> data = {}) {
    setup(packet);
    if (packet.length == 0) return status_in();
    if (packet.device_to_host()) return read(packet.length);
    while (!data.empty()) {
      const auto part = data.first(std::min<std::size_t>(64, data.size()));
      const Handshake handshake = port.out(0, part);
      if (handshake == Handshake::stall) return stall_result;
      REQUIRE(handshake == Handshake::ack);
      data = data.subspan(part.size());
      device.poll();
    }
    return status_in();
  }

  ControlResult get_descriptor(std::uint16_t value, std::uint16_t length, std::uint8_t recipient = 0,
                               std::uint16_t index = 0) {
    return control(request(static_cast<std::uint8_t>(0x80 | recipient), 6, value, index, length));
  }

  ControlResult configure(std::uint16_t value = 1) { return control(request(0x00, 9, value, 0, 0)); }

  template <class Report>
  ControlResult set_report(std::uint8_t type, const Report& report, std::size_t size = sizeof(Report)) {
    const auto bytes = std::as_bytes(std::span(&report, 1)).first(size);
    const auto id = static_cast<std::uint16_t>(bytes[0]);
    return control(request(0x21, 9, static_cast<std::uint16_t>(type << 8 | id), 0, static_cast<std::uint16_t>(size)),
                   bytes);
  }

  ControlResult get_report(std::uint8_t type, std::uint8_t id, std::uint16_t length) {
    return control(request(0xA1, 1, static_cast<std::uint16_t>(type << 8 | id), 0, length));
  }

  template <class Report>
  Report get_feature(protocol::ReportId id) {
    const ControlResult result = get_report(3, static_cast<std::uint8_t>(id), sizeof(Report));
    REQUIRE(result.data.size() == sizeof(Report));
    Report report;
    std::memcpy(&report, result.data.data(), sizeof report);
    return report;
  }

  /// Simulates control interrupts, which carry out commands and record samples. The recorded signals have test values.
  void run(std::uint32_t count, protocol::State state = protocol::State::ready,
           protocol::Fault fault = protocol::Fault::none) {
    for (std::uint32_t i = 0; i < count; ++i) {
      link.parameters.apply_offered(periods);
      if (const protocol::CommandReport* command = link.commands.pop()) last_command = *command;
      protocol::SignalValues signals{};
      signals[protocol::Signal::position_x_m] = static_cast<float>(periods);
      signals[protocol::Signal::gimbal_1_rad] = 1e-4f * static_cast<float>(periods % 30'000);
      interrupt(link, signals,
                {.state = state,
                 .fault = fault,
                 .is_referenced = true,
                 .command_token = link.commands.last_token(),
                 .periods = periods,
                 .begin_cycles = periods * cycles_per_period});
      link.poses.note_load(100);
      port.pass_period();
      link.scope.pack();
      link.black_box.follow();
      ++periods;
      link.status.record(state, {}, 100, 0, false);
    }
  }

  std::optional<protocol::CommandReport> last_command;
};

inline protocol::CommandReport command(protocol::Command kind, std::uint8_t token, std::uint32_t claim = 0,
                                       std::uint32_t ticket = 0) {
  protocol::CommandReport report{};
  report.command = kind;
  report.token = token;
  report.claim = claim;
  report.ticket = ticket;
  return report;
}

inline protocol::ClaimReport claim_report(protocol::ClaimOperation operation, std::uint32_t claim) {
  protocol::ClaimReport report{};
  report.operation = operation;
  report.claim = claim;
  report.process_id = 1000 + claim;
  std::memcpy(report.program, "trial", 5);
  return report;
}

template <class Report>
std::span<const std::byte> bytes_of(const Report& report) {
  return std::as_bytes(std::span(&report, 1));
}

}  // namespace inkwell::test
