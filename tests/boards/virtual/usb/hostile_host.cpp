#include "tests/boards/virtual/usb/hostile_host.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using namespace virtual_board;
using Setup = std::array<std::byte, 8>;
using Packet = std::vector<std::byte>;

constexpr std::uint64_t cases_in_a_batch = 200;
constexpr double byte_s = 1.0 / 1'500'000;
constexpr std::size_t token_bytes = 8;  // including overhead
constexpr unsigned own_address = 2;
constexpr std::uint8_t device_descriptor = 1, configuration_descriptor = 2, string_descriptor = 3;

Setup request(std::uint8_t type, std::uint8_t code, std::uint16_t value, std::uint16_t index, std::uint16_t length) {
  const auto low = [](std::uint16_t word) { return std::byte(word & 0xFF); };
  const auto high = [](std::uint16_t word) { return std::byte(word >> 8); };
  return {std::byte{type}, std::byte{code}, low(value),  high(value),
          low(index),      high(index),     low(length), high(length)};
}

Setup descriptor_request(std::uint8_t type) { return request(0x80, 6, static_cast<std::uint16_t>(type << 8), 0, 64); }

class HostileHost {
 public:
  HostileHost(const std::filesystem::path& image, std::uint64_t seed, std::uint64_t row) : bus_(image) {
    std::seed_seq numbers{seed, row};
    random_.seed(numbers);
    bus_.connect();
  }

  void one_case(HostileOutcome& outcome) {
    switch (random_() % 8) {
      case 0:
      case 1:
      case 2: setup_upon_setup(outcome); break;
      case 3: lose_handshakes(); break;
      case 4: confuse_stages(); break;
      case 5: random_setup(); break;
      case 6: random_transactions(); break;
      default:
        if (random_() % 16 == 0)
          reset_anywhere();
        else
          random_transactions();
        break;
    }
    ++outcome.cases;
  }

  /// Returns an error message, or nothing if the device works.
  std::optional<std::string> recover() {
    leave_packets_behind();
    reset();
    if (any_endpoint_open()) return "an endpoint still takes or sends packets after a bus reset";
    address_ = 0;
    if (!control_without_data(request(0x00, 5, own_address, 0, 0))) return "SET_ADDRESS is not answered";
    address_ = own_address;
    pause_s(0.002);
    setup(descriptor_request(device_descriptor));
    const auto descriptor = read_packet();
    if (!descriptor || descriptor->size() != 18 || (*descriptor)[1] != std::byte{device_descriptor})
      return "the device descriptor is not as it should be";
    if (!write_packet(0, true, {})) return "the status stage is not taken";
    if (!control_without_data(request(0x00, 9, 1, 0, 0))) return "SET_CONFIGURATION is not answered";
    unsigned poses = 0;
    for (int i = 0; i < 20; ++i) {
      pause_s(0.001);
      poses += in(1).has_value() ? 1 : 0;
    }
    const Packet nothing_to_do(64);
    if (!write_packet(1, false, nothing_to_do) || !write_packet(1, true, nothing_to_do)) return "reports are not taken";
    if (poses < 18) return fmt::format("{} poses came in 20 ms", poses);
    if (const auto broken = bus_.violations(); !broken.empty()) return broken.front();
    return std::nullopt;
  }

 private:
  void pause_s(double time_s) { bus_.run_for(time_s); }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  Handshake setup(const Setup& packet) {
    pause_s((2 * token_bytes + packet.size()) * byte_s);
    return bus_.cable.setup(address_, 0, packet);
  }

  /// Returns the data packet of an IN transaction, if the device sends a packet.
  std::optional<Packet> in(unsigned endpoint, bool acknowledged = true) {
    pause_s(token_bytes * byte_s);
    std::array<std::byte, full_speed_packet_maximum> data;
    const InReply reply = bus_.cable.in(address_, endpoint, data);
    if (reply.handshake != Handshake::ack) return std::nullopt;
    pause_s(static_cast<double>(reply.length + 5) * byte_s);
    if (acknowledged && !bus_.cable.finish_in(endpoint)) return std::nullopt;
    return Packet(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(reply.length));
  }

  Handshake out(unsigned endpoint, bool data1, std::span<const std::byte> data) {
    pause_s(static_cast<double>(token_bytes + data.size() + 5) * byte_s);
    return bus_.cable.out(address_, endpoint, data1, data);
  }

  static constexpr int tries = 300;  // about 10 us each
  std::optional<Packet> read_packet() {
    for (int i = 0; i < tries; ++i)
      if (auto packet = in(0)) return packet;
    return std::nullopt;
  }
  bool write_packet(unsigned endpoint, bool data1, std::span<const std::byte> data) {
    for (int i = 0; i < tries; ++i)
      if (out(endpoint, data1, data) == Handshake::ack) return true;
    return false;
  }
  bool control_without_data(const Setup& packet) {
    if (setup(packet) != Handshake::ack) return false;
    const auto status = read_packet();
    return status && status->empty();
  }

  /// Sends reports and a SET_ADDRESS request. The bus reset arrives before the firmware reads the packets.
  void leave_packets_behind() {
    constexpr unsigned elsewhere = 77;
    for (const bool data1 : {false, true}) bus_.cable.out(address_, 1, data1, Packet(64));
    bus_.cable.setup(address_, 0, request(0x00, 5, elsewhere, 0, 0));
    std::array<std::byte, full_speed_packet_maximum> data;
    bus_.cable.in(address_, 0, data);
  }
  /// Returns true if any endpoint except endpoint 0 OUT can accept or send packets.
  bool any_endpoint_open() {
    constexpr std::uint32_t in_control = 0x900, out_control = 0xB00, naksts = 1u << 17, epena = 1u << 31;
    const auto is_open = [this](std::uint32_t control) {
      const std::uint32_t bits = bus_.core.read(control, 4);
      return (bits & epena) != 0 && (bits & naksts) == 0;
    };
    bool any = (bus_.core.read(in_control, 4) & epena) != 0;
    for (std::uint32_t i = 1; i < OtgFsDevice::endpoint_count; ++i)
      any |= is_open(in_control + 0x20 * i) || is_open(out_control + 0x20 * i);
    return any;
  }

  void reset() {
    bus_.cable.begin_reset();
    pause_s(between(0.0001, 0.001));
    bus_.cable.end_reset();
    pause_s(0.0005);
  }
  void reset_anywhere() {
    setup(descriptor_request(configuration_descriptor));
    pause_s(between(0, 100e-6));
    reset();
    address_ = 0;
    if (control_without_data(request(0x00, 5, own_address, 0, 0))) address_ = own_address;
    pause_s(0.0005);
    control_without_data(request(0x00, 9, 1, 0, 0));
  }

  void setup_upon_setup(HostileOutcome& outcome) {
    constexpr std::array kinds{device_descriptor, configuration_descriptor, string_descriptor};
    const std::size_t first = random_() % kinds.size();
    const std::uint8_t wanted = kinds[(first + 1 + random_() % 2) % kinds.size()];
    for (auto before = 1 + random_() % 12; before > 0; --before) {
      setup(descriptor_request(kinds[first]));
      pause_s(between(0, 40e-6));
      if (random_() % 2 == 0) continue;
      // The next SETUP packet arrives while the device prepares the answer.
      random_() % 2 == 0 ? void(in(0, random_() % 2 == 0)) : void(out(0, true, {}));
      pause_s(between(0, 20e-6));
    }
    if (setup(descriptor_request(wanted)) != Handshake::ack) return;
    const auto answer = read_packet();
    if (!answer) {
      std::array<std::byte, full_speed_packet_maximum> data;
      const bool stalled = bus_.cable.in(address_, 0, data).handshake == Handshake::stall;
      ++(stalled ? outcome.stalled_answers : outcome.missing_answers);
      return;
    }
    ++outcome.answers;
    if (answer->size() < 2 || (*answer)[1] != std::byte{wanted}) ++outcome.wrong_answers;
    write_packet(0, true, {});
  }

  void lose_handshakes() {
    setup(descriptor_request(device_descriptor));
    for (int i = 0; i < 20; ++i) in(0, random_() % 2 == 0);
    write_packet(0, true, {});
  }

  void confuse_stages() {
    setup(random_() % 2 == 0 ? descriptor_request(device_descriptor) : request(0x21, 9, 0x0201, 0, 37));
    Packet data(random_() % 65);
    for (int i = 0; i < 6; ++i) {
      if (random_() % 2 == 0)
        out(0, random_() % 2 == 0, data);
      else
        in(0, random_() % 4 != 0);
      pause_s(between(0, 60e-6));
    }
  }

  // SET_ADDRESS is excluded, because this host does not change its address.
  void random_setup() {
    Setup packet;
    for (std::byte& one : packet) one = std::byte(random_() & 0xFF);
    if (random_() % 2 == 0) packet[0] = std::array{std::byte{0x80}, std::byte{0x21}, std::byte{0xA1}}[random_() % 3];
    if ((packet[0] & std::byte{0x60}) == std::byte{0} && packet[1] == std::byte{5}) packet[1] = std::byte{6};
    setup(packet);
    random_transactions();
  }

  void random_transactions() {
    for (auto count = random_() % 8; count > 0; --count) {
      const unsigned endpoint = random_() % 4;
      if (random_() % 2 == 0) {
        in(endpoint, random_() % 4 != 0);
      } else {
        Packet data(random_() % 65);
        for (std::byte& one : data) one = std::byte(random_() & 0xFF);
        out(endpoint, random_() % 2 == 0, data);
      }
      pause_s(between(0, 40e-6));
    }
  }

  FirmwareOnBus bus_;
  std::mt19937_64 random_;
  unsigned address_ = own_address;
};

}  // namespace

HostileOutcome be_hostile(const std::filesystem::path& image, std::uint64_t from, std::uint64_t end,
                          std::uint64_t seed) {
  HostileOutcome outcome;
  for (std::uint64_t row = from / hostile_cases_in_a_row; row * hostile_cases_in_a_row < end; ++row) {
    HostileHost host(image, seed, row);
    const std::uint64_t last = std::min((row + 1) * hostile_cases_in_a_row, end);
    for (std::uint64_t number = row * hostile_cases_in_a_row; number < last;) {
      const std::uint64_t first = number;
      while (number < std::min(first + cases_in_a_batch, last)) {
        host.one_case(outcome);
        ++number;
      }
      if (const auto failure = host.recover()) {
        outcome.failures.push_back(fmt::format("in cases {} to {} of seed {} (again by --from {} --cases {}): {}",
                                               first, number - 1, seed, first, number - first, *failure));
        return outcome;
      }
    }
  }
  return outcome;
}

}  // namespace inkwell::virtual_usb_test
