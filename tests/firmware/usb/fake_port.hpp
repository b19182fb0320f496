// A simulated USB port and its host. The host sends and receives single packets, valid or invalid.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "firmware/usb/port.hpp"

namespace inkwell::test {

using Bytes = std::vector<std::byte>;

inline Bytes to_bytes(std::span<const std::byte> data) { return {data.begin(), data.end()}; }

enum class Handshake { ack, nak, stall };

struct InPacket {
  Handshake handshake = Handshake::nak;
  Bytes data{};
};

/// Behaves as documented in usb::Port. The test fails if the device violates the documented rules.
class FakePort final : public usb::Port {
 public:
  // ---- device side ----

  bool next_event(usb::Event& event) override {
    if (events_.empty()) return false;
    event = events_.front();
    events_.pop_front();
    return true;
  }

  void set_address(std::uint8_t address) override { address_ = address; }

  void open(std::uint8_t endpoint_address, usb::EndpointType type) override {
    forget_transfer(endpoint_address);
    Endpoint& endpoint = at(endpoint_address);
    endpoint = {};
    endpoint.open = true;
    endpoint.type = type;
  }

  void close(std::uint8_t endpoint_address) override {
    forget_transfer(endpoint_address);
    at(endpoint_address) = {};
  }

  void stall(std::uint8_t endpoint_address) override {
    if (is_stale(endpoint_address)) return;
    CHECK(at(endpoint_address).open);
    at(endpoint_address).stalled = true;
    if (endpoint_address == 0x80) at(0x00).stalled = true;
    forget_transfer(endpoint_address);
  }

  void clear_stall(std::uint8_t endpoint_address) override {
    Endpoint& endpoint = at(endpoint_address);
    CHECK(endpoint.open);
    forget_transfer(endpoint_address);
    endpoint.stalled = false;
    endpoint.data1 = false;
  }

  void send(std::uint8_t endpoint_address, std::span<const std::byte> data) override {
    if (is_stale(endpoint_address)) return;
    Endpoint& endpoint = at(endpoint_address);
    CHECK((endpoint_address & 0x80) != 0);
    CHECK(endpoint.open);
    CHECK_MESSAGE(!endpoint.running, "one transfer at a time");
    CHECK_FALSE(endpoint.stalled);
    if (endpoint_address == 0x80) CHECK(data.size() <= usb::packet_size_maximum);
    endpoint.running = true;
    endpoint.data = data;
    endpoint.data_at_start.assign(data.begin(), data.end());
    endpoint.offset = 0;
  }

  bool cancel(std::uint8_t endpoint_address) override {
    ++at(endpoint_address).cancels;
    if (polled_in_cancel == (endpoint_address & 0x7F)) in(*std::exchange(polled_in_cancel, std::nullopt));
    const bool was_left = at(endpoint_address).running;
    forget_transfer(endpoint_address);
    return was_left;
  }

  void receive(std::uint8_t endpoint_address) override {
    if (is_stale(endpoint_address)) return;
    CHECK((endpoint_address & 0x80) == 0);
    CHECK(at(endpoint_address).open);
    at(endpoint_address).armed = true;
  }

  std::optional<usb::BusFrame> bus_frame() override {
    if (!frames_run) return std::nullopt;
    usb::BusFrame frame = frame_;
    frame.now_cycles = frame.begin_cycles + age_cycles_;
    return frame;
  }

  // ---- host side ----

  /// Advances time by one control period. A bus frame has twenty control periods. The main loop runs in the middle of
  /// each period.
  void pass_period() {
    age_cycles_ += period_cycles;
    if (age_cycles_ < frame_cycles) return;
    age_cycles_ -= frame_cycles;
    frame_.begin_cycles += frame_cycles;
    ++frame_.count;
    frame_.number = frame_.count % 2048;
  }
  bool frames_run = true;
  /// The host polls this endpoint once, just before a cancellation by the device.
  std::optional<std::uint8_t> polled_in_cancel;

  void reset() {
    for (Endpoint& endpoint : endpoints_) endpoint = {};
    at(0x00).open = at(0x80).open = true;
    address_ = 0;
    events_.clear();
    push(usb::Event::Kind::reset);
  }
  void suspend() { push(usb::Event::Kind::suspend); }
  void resume() { push(usb::Event::Kind::resume); }

  /// Sends a SETUP packet, which always ends a stall of endpoint 0.
  void setup(std::span<const std::byte> packet) {
    at(0x00).stalled = at(0x80).stalled = false;
    at(0x00).armed = false;
    push(usb::Event::Kind::setup, 0, packet);
  }

  Handshake out(std::uint8_t number, std::span<const std::byte> packet) {
    Endpoint& endpoint = at(number);
    if (endpoint.stalled) return Handshake::stall;
    if (!endpoint.open || !endpoint.armed) return Handshake::nak;
    endpoint.armed = false;
    endpoint.data1 = !endpoint.data1;
    push(usb::Event::Kind::received, number, packet);
    return Handshake::ack;
  }

  InPacket in(std::uint8_t number) {
    Endpoint& endpoint = at(static_cast<std::uint8_t>(0x80 | number));
    if (endpoint.stalled) return {Handshake::stall};
    if (!endpoint.open || !endpoint.running) return {Handshake::nak};
    CHECK_MESSAGE(std::ranges::equal(endpoint.data, endpoint.data_at_start), "what is being sent must not change");
    const std::size_t size = std::min(endpoint.data.size() - endpoint.offset, usb::packet_size_maximum);
    InPacket packet{Handshake::ack, to_bytes(endpoint.data.subspan(endpoint.offset, size))};
    endpoint.offset += size;
    endpoint.data1 = !endpoint.data1;
    if (endpoint.offset == endpoint.data.size()) {
      endpoint.running = false;
      push(usb::Event::Kind::sent, number);
    }
    return packet;
  }

  std::uint8_t address() const { return address_; }
  bool is_open(std::uint8_t endpoint_address) { return at(endpoint_address).open; }
  bool is_stalled(std::uint8_t endpoint_address) { return at(endpoint_address).stalled; }
  bool data_toggle(std::uint8_t endpoint_address) { return at(endpoint_address).data1; }
  /// Number of cancel() calls since the endpoint was opened.
  unsigned cancels(std::uint8_t endpoint_address) { return at(endpoint_address).cancels; }
  bool idle() const { return events_.empty(); }

 private:
  struct Endpoint {
    bool open = false;
    usb::EndpointType type = usb::EndpointType::control;
    bool stalled = false;
    bool armed = false;    ///< OUT: accepts a packet
    bool running = false;  ///< IN: a transfer is in progress
    bool data1 = false;
    std::span<const std::byte> data{};
    Bytes data_at_start{};
    std::size_t offset = 0;
    unsigned cancels = 0;
  };

  Endpoint& at(std::uint8_t endpoint_address) {
    if ((endpoint_address & 0x7F) >= 4) FAIL("there is no endpoint ", int{endpoint_address});
    return endpoints_[(endpoint_address & 0x80 ? 4u : 0u) + (endpoint_address & 0x03u)];
  }

  bool is_stale(std::uint8_t endpoint_address) const {
    const auto is_setup = [](const usb::Event& event) { return event.kind == usb::Event::Kind::setup; };
    return (endpoint_address & 0x7F) == 0 && std::any_of(events_.begin(), events_.end(), is_setup);
  }

  void forget_transfer(std::uint8_t endpoint_address) {
    if ((endpoint_address & 0x80) == 0) return;
    at(endpoint_address).running = false;
    std::erase_if(events_, [&](const usb::Event& event) {
      return event.kind == usb::Event::Kind::sent && event.endpoint == (endpoint_address & 0x0F);
    });
  }

  void push(usb::Event::Kind kind, std::uint8_t number = 0, std::span<const std::byte> data = {}) {
    usb::Event event;
    event.kind = kind;
    event.endpoint = number;
    event.length = static_cast<std::uint8_t>(data.size());
    REQUIRE(data.size() <= event.data.size());
    std::copy(data.begin(), data.end(), event.data.begin());
    events_.push_back(event);
  }

  std::array<Endpoint, 8> endpoints_{};
  std::deque<usb::Event> events_;
  static constexpr std::uint32_t period_cycles = 8400, frame_cycles = 20 * period_cycles;
  usb::BusFrame frame_{.begin_cycles = 0u - frame_cycles, .length_cycles = frame_cycles};
  std::uint32_t age_cycles_ = frame_cycles - period_cycles / 2;
  std::uint8_t address_ = 0;
};

}  // namespace inkwell::test
