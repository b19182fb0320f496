// Tests the flashed firmware after a repeated configuration, and after a bus reset during pending transfers.
#include <doctest/doctest.h>

#include <array>
#include <map>
#include <optional>

#include "protocol/reports.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

constexpr std::uint8_t set_configuration = 9;
constexpr unsigned command_endpoint = 1, pose_endpoint = 1, scope_endpoint = 2, controller_endpoint = 3;

protocol::CommandReport clear_fault(std::uint8_t token) {
  protocol::CommandReport report{};
  report.command = protocol::Command::clear_fault;
  report.token = token;
  return report;
}

struct Host {
  Host() : bus(flashed_image()) {
    bus.connect();
    bus.on_pose = [this](const protocol::PoseReport& pose) { newest = pose; };
    bus.cable.on_in = [this](unsigned endpoint, const virtual_board::InReply& reply, std::span<const std::byte>) {
      if (reply.handshake == virtual_board::Handshake::ack) first_toggles.try_emplace(endpoint, reply.data1);
    };
  }

  /// Configures the device and discards all pending requests.
  void configure() {
    REQUIRE(bus.control(0x00, set_configuration, 1, 0, 0).status == 0);
    first_toggles.clear();
    bus.keep_asking_for_poses();
    bus.keep_asking_the_controller();
  }

  /// Sends a command. Returns true if the firmware executes the command within 10 ms.
  bool is_obeyed(std::uint8_t token) {
    bus.send_report(clear_fault(token));
    bus.run_for(0.01);
    return newest && newest->command_token == token;
  }

  FirmwareOnBus bus;
  std::optional<protocol::PoseReport> newest;
  std::map<unsigned, bool> first_toggles;
};

}  // namespace

TEST_CASE("a second configuration resets every data toggle from any state") {
  Host host;
  std::uint8_t token = 0;
  // The rounds send different numbers of packets, so the data toggle has both values before a configuration.
  for (int round = 0; round < 4; ++round) {
    CAPTURE(round);
    host.configure();
    CHECK(host.is_obeyed(++token));
    host.bus.stream_scope(std::array{protocol::Signal::position_x_m});
    host.bus.run_for(0.02);
    for (const unsigned endpoint : {pose_endpoint, scope_endpoint, controller_endpoint}) {
      CAPTURE(endpoint);
      REQUIRE(host.first_toggles.contains(endpoint));
      CHECK_FALSE(host.first_toggles[endpoint]);
    }
    for (int i = 0; i <= round; ++i) CHECK(host.is_obeyed(++token));
    host.bus.run_for(0.001 * round);
  }
  for (const auto& sentence : host.bus.violations()) FAIL_CHECK(sentence);
}

TEST_CASE("a device without a configuration answers on endpoint 0 only") {
  using virtual_board::Handshake;
  Host host;
  host.configure();
  REQUIRE(host.bus.control(0x00, set_configuration, 0, 0, 0).status == 0);
  constexpr unsigned own_address = 2;
  std::array<std::byte, virtual_board::full_speed_packet_maximum> packet{};
  for (const unsigned endpoint : {pose_endpoint, scope_endpoint, controller_endpoint}) {
    CAPTURE(endpoint);
    CHECK(host.bus.cable.in(own_address, endpoint, packet).handshake == Handshake::nothing);
  }
  CHECK(host.bus.cable.out(own_address, command_endpoint, false, packet) == Handshake::nothing);
  CHECK(host.bus.cable.in(own_address, 0, packet).handshake == Handshake::nak);
}

TEST_CASE("after each of several bus resets the device enumerates, executes commands and breaks no rule") {
  Host host;
  for (std::uint8_t token = 1; token < 5; ++token) {
    CAPTURE(token);
    host.bus.port.release();
    host.bus.run_for(0.02);
    host.bus.port.import();
    host.bus.run_for(0.2);
    host.configure();
    CHECK(host.is_obeyed(token));
  }
  for (const auto& sentence : host.bus.violations()) FAIL_CHECK(sentence);
}

}  // namespace inkwell::virtual_usb_test
