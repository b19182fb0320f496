// A root port, the OTG_FS core, a driver and a host. The host records every result.
#pragma once

#include <doctest/doctest.h>

#include <map>

#include "boards/virtual/usb/root_port.hpp"

#include "tests/boards/virtual/usb/fake_board.hpp"
#include "tests/boards/virtual/usb/fake_firmware.hpp"

namespace inkwell::virtual_usb_test {

using virtual_board::OtgFsDevice;
using virtual_board::RootPort;
using virtual_board::ticks;
using virtual_board::Urb;

struct Outcome {
  std::int32_t status;
  Bytes data;
  std::uint32_t actual;
  Ticks when;
};

class RootPortBench final : public RootPort::Client {
 public:
  explicit RootPortBench(double host_clock_ppm = 0.0)
      : core({scheduler, interrupts, log, log, state, triggers}),
        firmware(core, scheduler),
        port(scheduler, core, *this, host_clock_ppm) {}

  void run_for(double time_s) {
    const Ticks end = scheduler.now() + ticks(time_s);
    while (scheduler.run_one(end))
      for (int i = 0; interrupts.asserted() && i < 20; ++i) firmware.handle_interrupt();
    scheduler.pass_until(end);
  }
  void enumerate() {
    port.plug(true);
    firmware.start();
    run_for(0.5);
    REQUIRE(port.enumerated());
  }
  void use(bool configure = true) {
    enumerate();
    port.import();
    if (configure) REQUIRE(control(0x00, 9, 5, 0).status == 0);
  }
  std::uint32_t submit(Urb urb) {
    urb.sequence = ++sequence;
    port.submit(std::move(urb));
    return sequence;
  }
  std::uint32_t submit_control(unsigned type, unsigned request, unsigned value, unsigned length, Bytes data = {},
                               unsigned index = 0) {
    Urb urb;
    urb.in = (type & 0x80) != 0;
    urb.length = length;
    urb.data = std::move(data);
    const std::array<unsigned, 8> bytes{type, request, value, value >> 8, index, 0, length, length >> 8};
    for (std::size_t i = 0; i < 8; ++i) urb.setup[i] = std::byte(bytes[i] & 0xFF);
    return submit(std::move(urb));
  }
  Outcome wait_for(std::uint32_t which, double time_s = 1.0) {
    for (double waited = 0; waited < time_s && !outcomes.contains(which); waited += 0.001) run_for(0.001);
    REQUIRE(outcomes.contains(which));
    return outcomes.at(which);
  }
  Outcome control(unsigned type, unsigned request, unsigned value, unsigned length, Bytes data = {},
                  unsigned index = 0) {
    return wait_for(submit_control(type, request, value, length, std::move(data), index));
  }
  std::uint32_t submit_in(unsigned endpoint, std::uint32_t length, std::uint32_t flags = 0) {
    Urb urb;
    urb.endpoint = static_cast<std::uint8_t>(endpoint);
    urb.in = true;
    urb.length = length;
    urb.flags = flags;
    return submit(std::move(urb));
  }
  std::uint32_t submit_out(unsigned endpoint, Bytes data, std::uint32_t flags = 0) {
    Urb urb;
    urb.endpoint = static_cast<std::uint8_t>(endpoint);
    urb.length = static_cast<std::uint32_t>(data.size());
    urb.data = std::move(data);
    urb.flags = flags;
    return submit(std::move(urb));
  }

  void between_transactions() override {}
  void enumerated(const virtual_board::DeviceDescription& seen) override { description = seen; }
  void detached() override { ++detachments; }
  void completed(Urb&& urb, std::int32_t result) override {
    REQUIRE_FALSE(outcomes.contains(urb.sequence));
    const std::uint32_t actual = urb.actual_length();
    outcomes[urb.sequence] = {result, std::move(urb.data), actual, scheduler.now()};
  }

  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  FakeTriggers triggers;
  OtgFsDevice core;
  FakeFirmware firmware;
  RootPort port;
  std::uint32_t sequence = 0;
  std::map<std::uint32_t, Outcome> outcomes;
  virtual_board::DeviceDescription description;
  int detachments = 0;
};

}  // namespace inkwell::virtual_usb_test
