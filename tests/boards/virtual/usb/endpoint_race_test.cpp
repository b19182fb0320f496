// Tests host actions between a register read and a register write of the driver.
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <optional>

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {

namespace {

constexpr unsigned own_address = 2, pose_endpoint = 1;
constexpr std::uint32_t control_of_poses = 0x920, epena = 1u << 31;

}  // namespace

TEST_CASE("a pose that the host reads while the driver withdraws it is not sent again") {
  for (const int token_at : {1, 2, 3}) {
    CAPTURE(token_at);
    FirmwareOnBus bus(flashed_image());
    bus.connect();
    bus.run_for(0.01);
    std::array<std::byte, virtual_board::full_speed_packet_maximum> packet;
    int reads = 0;
    bool taken = false;
    // To replace a waiting pose, the driver reads the endpoint's control register twice. The second read of the
    // register is part of a read-modify-write access.
    bus.registers.on_read = [&](std::uint32_t offset, std::uint32_t value) {
      if (offset != control_of_poses || (value & epena) == 0) return;
      ++reads;
      if (reads == token_at) bus.core.in(own_address, pose_endpoint, packet);
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

TEST_CASE("a pose that the host reads while a newer pose of the same frame replaces it is not sent twice") {
  // If the host requests no report, first the spare report and then the newest report replace the waiting report.
  for (const int replacement : {1, 2}) {
    CAPTURE(replacement);
    FirmwareOnBus bus(flashed_image());
    bus.connect();
    bus.run_for(0.01);
    std::array<std::byte, virtual_board::full_speed_packet_maximum> packet;
    int replacements = 0, reads = 0;
    Ticks last_read = 0;
    bool taken = false;
    bus.registers.on_read = [&](std::uint32_t offset, std::uint32_t value) {
      if (offset != control_of_poses || (value & epena) == 0) return;
      if (bus.chip.now() - last_read > ticks(100e-6)) reads = 0, ++replacements;
      last_read = bus.chip.now();
      ++reads;
      if (replacements != replacement) return;
      if (reads == 1) bus.core.in(own_address, pose_endpoint, packet);
      if (reads == 2) taken = bus.core.finish_in(pose_endpoint);
    };
    for (int i = 0; i < 500 && !taken; ++i) bus.run_for(10e-6);
    REQUIRE(taken);
    protocol::PoseReport first;
    std::memcpy(&first, packet.data(), sizeof first);
    bus.registers.on_read = {};
    // The test reads the next packet directly, because the host model missed the previous packet.
    std::optional<protocol::PoseReport> next;
    bus.cable.on_start_of_frame = [&](std::uint16_t) {
      if (next || bus.core.in(own_address, pose_endpoint, packet).handshake != virtual_board::Handshake::ack) return;
      std::memcpy(&next.emplace(), packet.data(), sizeof *next);
      bus.core.finish_in(pose_endpoint);
    };
    bus.run_for(0.003);
    REQUIRE(next);
    CHECK(next->sequence == first.sequence + 1);
  }
}

namespace {

constexpr std::uint32_t receive_pop = 0x020, control_in = 0x900, control_out = 0xB00, fifos = 0x1000, naksts = 1u << 17;
constexpr std::uint8_t device_descriptor = 1, configuration_descriptor = 2;
using Setup = std::array<std::byte, 8>;

constexpr Setup set_idle{std::byte{0x21}, std::byte{0x0A}};
Setup descriptor_request(std::uint8_t type) {
  return {std::byte{0x80}, std::byte{6}, std::byte{0}, std::byte{type}, {}, {}, std::byte{64}, {}};
}

/// The host sends a SETUP packet, a token and, at a chosen time, a second SETUP packet.
struct Race {
  Race() : bus(flashed_image()) { bus.connect(); }

  void begin(const Setup& setup) {
    bus.cable.setup(own_address, 0, setup);
    bus.cable.in(own_address, 0, packet);  // completes the stage of this SETUP
    came = read = false;
  }
  void interfere() {
    came = true;
    bus.cable.setup(own_address, 0, descriptor_request(configuration_descriptor));
    // The next token follows at least 4 us after the SETUP packet.
    auto& scheduler = bus.chip.connections().scheduler;
    scheduler.at(scheduler.now() + ticks(1e-6), [this] {
      if (read || fills) return;  // a register read would disturb the words of a packet
      CHECK((bus.core.read(control_in, 4) & naksts) != 0);
      CHECK((bus.core.read(control_out, 4) & naksts) != 0);
    });
  }
  /// Returns the descriptor type in the device's last answer, or 0 if there is no answer.
  std::uint8_t answer() {
    for (int i = 0; i < 300; ++i) {
      bus.run_for(10e-6);
      const auto reply = bus.cable.in(own_address, 0, packet);
      if (reply.handshake != virtual_board::Handshake::ack) continue;
      bus.cable.finish_in(0);
      return reply.length >= 2 ? static_cast<std::uint8_t>(packet[1]) : 0;
    }
    return 0;
  }

  FirmwareOnBus bus;
  std::array<std::byte, virtual_board::full_speed_packet_maximum> packet{};
  bool came = false, read = false, fills = false;
};

}  // namespace

TEST_CASE("a SETUP packet during the answer to the previous packet is answered correctly after every register access") {
  Race race;
  for (const Setup& first : {descriptor_request(device_descriptor), set_idle}) {
    bool too_late = false;
    for (int access = 1; !too_late; ++access) {
      CAPTURE(access);
      int left = access;
      race.begin(first);
      const auto count = [&] {
        if (--left == 0) race.interfere();
      };
      race.bus.registers.on_read = [&](std::uint32_t offset, std::uint32_t) {
        race.read |= race.came && offset == receive_pop;
        race.fills = false;
        count();
      };
      race.bus.registers.on_write = [&](std::uint32_t offset) {
        race.fills = offset >= fifos;
        count();
      };
      race.bus.run_for(60e-6);
      race.bus.registers.on_read = {};
      race.bus.registers.on_write = {};
      too_late = !race.came;
      if (too_late)
        CHECK(access > 15);
      else
        CHECK(race.answer() == configuration_descriptor);
      race.bus.run_for(0.001);
    }
  }
  for (const auto& sentence : race.bus.violations()) FAIL_CHECK(sentence);
}

TEST_CASE("while a SETUP has been read and its end has not, nothing is made ready") {
  Race race;
  race.begin(descriptor_request(device_descriptor));
  // The second SETUP arrives while the driver answers the first SETUP. The driver reads the second SETUP before it
  // answers the first SETUP.
  constexpr std::uint32_t setup_done = 4;
  race.bus.registers.on_read = [&](std::uint32_t offset, std::uint32_t value) {
    if (!race.came && offset == receive_pop && (value >> 17 & 0xF) == setup_done) race.interfere();
  };
  race.bus.run_for(100e-6);
  REQUIRE(race.came);
  CHECK((race.bus.core.read(control_in, 4) & naksts) != 0);
  CHECK((race.bus.core.read(control_out, 4) & naksts) != 0);
  CHECK(race.answer() == configuration_descriptor);
  for (const auto& sentence : race.bus.violations()) FAIL_CHECK(sentence);
}

}  // namespace inkwell::virtual_usb_test
