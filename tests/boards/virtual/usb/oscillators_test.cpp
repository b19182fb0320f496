// Tests the flashed firmware with inaccurate oscillators and crystals, within and beyond the limits of the data sheets.
#include <doctest/doctest.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "boards/omni_driver/facts.hpp"
#include "protocol/self_test.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using virtual_board::ChipOptions;
using virtual_board::PinLevel;
using virtual_board::ResetCause;
using virtual_board::ticks;

struct OtherBoard {
  explicit OtherBoard(const ChipOptions& options) : bus(flashed_image(), 0.0, options) {}
  std::uint32_t watchdog_resets() const {
    return bus.chip.counters().resets[static_cast<std::size_t>(ResetCause::independent_watchdog)];
  }
  protocol::SelfTestEntry watchdog_entry() {
    const auto answer = bus.control(0xA1, 1, 0x0300 | static_cast<std::uint16_t>(protocol::ReportId::self_test), 0,
                                    sizeof(protocol::SelfTestReport));
    protocol::SelfTestReport report;
    REQUIRE(answer.data.size() == sizeof report);
    std::memcpy(&report, answer.data.data(), sizeof report);
    return report.entries[static_cast<std::size_t>(protocol::SelfTestItem::watchdog)];
  }
  protocol::Fault fault() {
    protocol::PoseReport pose{};
    bus.on_pose = [&](const protocol::PoseReport& newest) { pose = newest; };
    bus.keep_asking_for_poses();
    bus.run_for(0.01);
    bus.on_pose = nullptr;
    return pose.fault;
  }
  FirmwareOnBus bus;
};

}  // namespace

TEST_CASE("with the largest crystal error that USB tolerates, each bus frame of the host has a pose") {
  for (const int ppm : {-2'400, 50, 2'400}) {
    CAPTURE(ppm);
    OtherBoard other({.crystal_ppm = ppm});
    FirmwareOnBus& bus = other.bus;
    bus.connect();
    CHECK(bus.chip.clocks().hclk_Hz == board::processor_Hz + board::processor_Hz / 1'000'000 * ppm);
    int bus_frames = 0, poses = 0;
    bus.keep_asking_for_poses();
    bus.run_for(0.05);
    bus.cable.on_start_of_frame = [&](std::uint16_t) { ++bus_frames; };
    bus.cable.on_finished_in = [&](unsigned endpoint, bool done) { poses += endpoint == 1 && done ? 1 : 0; };
    bus.run_for(0.2);
    CHECK(bus_frames >= 199);
    CHECK(poses >= bus_frames - 1);
    for (const auto& sentence : bus.violations()) FAIL_CHECK(sentence);
  }
}

TEST_CASE("a crystal error of 2600 ppm prevents the USB connection and breaks the rule for the USB clock") {
  OtherBoard other({.crystal_ppm = 2'600});
  FirmwareOnBus& bus = other.bus;
  CHECK_THROWS_AS(bus.connect(), std::runtime_error);
  REQUIRE(bus.violations().size() == 1);
  CHECK(bus.chip.violations().front().rule == virtual_board::Rule::usb_clock);
}

TEST_CASE("on the slowest and the fastest chip, the watchdog resets firmware that hangs and no working firmware") {
  struct Sort {
    std::uint32_t low_speed_internal_Hz;
    double not_before_s, by_s;
  };
  for (const Sort& sort : {Sort{17'000, 0.0366, 0.0387}, Sort{47'000, 0.0126, 0.0147}}) {
    CAPTURE(sort.low_speed_internal_Hz);
    OtherBoard other({.low_speed_internal_Hz = sort.low_speed_internal_Hz});
    FirmwareOnBus& bus = other.bus;
    bus.connect();
    bus.run_for(0.3);
    bus.chip.clear_counters();  // the watchdog has expired once in its test
    constexpr unsigned control_interrupt = virtual_board::exception_of(virtual_board::converters_position);
    bus.chip.lose_exception(control_interrupt, true);
    bus.run_for(sort.not_before_s);
    CHECK(other.watchdog_resets() == 0);
    bus.run_for(sort.by_s - sort.not_before_s);
    CHECK(other.watchdog_resets() == 1);
  }
}

TEST_CASE("at power-on the firmware lets the watchdog expire, and the self-test reports whether the time was correct") {
  using protocol::SelfTestResult;
  struct Sort {
    std::uint32_t low_speed_internal_Hz;
    SelfTestResult result;
    double expired_after_ms;
  };
  for (const Sort& sort : {Sort{32'000, SelfTestResult::passed, 20.0}, Sort{17'000, SelfTestResult::passed, 37.6},
                           Sort{47'000, SelfTestResult::passed, 13.6}, Sort{14'000, SelfTestResult::failed, 45.7},
                           Sort{56'000, SelfTestResult::failed, 11.4}, Sort{500, SelfTestResult::failed, 0.0}}) {
    CAPTURE(sort.low_speed_internal_Hz);
    OtherBoard other({.low_speed_internal_Hz = sort.low_speed_internal_Hz});
    other.bus.connect();
    CHECK(other.watchdog_resets() == (sort.expired_after_ms > 0.0 ? 1 : 0));
    CHECK(other.watchdog_entry().result == sort.result);
    CHECK(other.watchdog_entry().figure == doctest::Approx(sort.expired_after_ms).epsilon(0.01));
    CHECK(other.fault() != protocol::Fault::watchdog);
  }
}

TEST_CASE("the result of the watchdog test is reported again after another reset without a second watchdog reset") {
  OtherBoard other({});
  other.bus.connect();
  const float expired_after_ms = other.watchdog_entry().figure;
  other.bus.chip.reset(ResetCause::pin);
  other.bus.run_for(0.05);  // the port detects that the device was disconnected
  other.bus.connect();
  CHECK(other.watchdog_resets() == 1);
  CHECK(other.watchdog_entry().result == protocol::SelfTestResult::passed);
  CHECK(other.watchdog_entry().figure == expired_after_ms);
}

TEST_CASE("an interrupted watchdog test measures nothing and does not hide a later watchdog reset") {
  OtherBoard other({});
  FirmwareOnBus& bus = other.bus;
  bus.run_for(0.01);
  bus.chip.reset(ResetCause::pin);
  bus.connect();
  CHECK(other.watchdog_resets() == 0);
  CHECK(other.watchdog_entry().result == protocol::SelfTestResult::passed);
  CHECK(other.watchdog_entry().figure == 0.0f);
  bus.chip.stall(ticks(0.03));
  bus.run_for(0.03);
  CHECK(other.watchdog_resets() == 1);
  bus.connect();
  CHECK(other.fault() == protocol::Fault::watchdog);
}

TEST_CASE("firmware that the boot loader starts skips the watchdog test") {
  OtherBoard other({});
  other.bus.chip.reset(ResetCause::power_on);
  other.bus.chip.start_by_boot_loader();
  other.bus.connect();
  CHECK(other.watchdog_resets() == 0);
  CHECK(other.watchdog_entry().result == protocol::SelfTestResult::passed);
  CHECK(other.watchdog_entry().figure == 0.0f);
}

TEST_CASE("if the crystal does not start, light and console report it, and a late start raises a fault") {
  OtherBoard other({});
  FirmwareOnBus& bus = other.bus;
  std::string console;
  virtual_board::Ticks first = 0, last = 0;
  bus.chip.on_usart = [&](unsigned, std::uint8_t byte) {
    console += static_cast<char>(byte);
    last = bus.chip.now();
    if (first == 0) first = last;
  };
  bus.chip.let_crystal_swing(false);
  bus.chip.reset();
  bus.run_for(0.3);
  int changes = 0;
  PinLevel before = PinLevel::floating;
  for (int i = 0; i < 200; ++i) {
    bus.run_for(0.005);
    const PinLevel now = bus.chip.pin_output(board::omni_driver.status_led.port, board::omni_driver.status_led.number);
    changes += now != before ? 1 : 0;
    before = now;
    CHECK(bus.chip.pin_output(board::omni_driver.bridge_enable.port, board::omni_driver.bridge_enable.number) !=
          PinLevel::high);
    for (const auto& bridge : board::omni_driver.bridges)
      for (const auto& leg : {bridge.leg_a.pin, bridge.leg_b.pin})
        CHECK(bus.chip.pin_output(leg.port, leg.number) == PinLevel::floating);
  }
  CHECK(changes >= 19);
  CHECK(changes <= 22);
  CHECK(bus.core.attachment() == 0);
  CHECK(bus.chip.clocks().hclk_Hz == 16'000'000);
  CHECK(console.find("the crystal does not oscillate") != std::string::npos);
  CHECK(console.find("\r\n") == console.size() - 2);
  constexpr double bits_of_a_character = 10, baud_Hz = 115'200;
  const double bits = virtual_board::seconds(last - first) * baud_Hz;
  CHECK(bits / (bits_of_a_character * static_cast<double>(console.size() - 1)) == doctest::Approx(1.0).epsilon(0.01));

  bus.chip.let_crystal_swing(true);
  bus.connect();
  protocol::PoseReport pose{};
  bus.on_pose = [&](const protocol::PoseReport& newest) { pose = newest; };
  bus.keep_asking_for_poses();
  bus.run_for(0.01);
  CHECK(pose.state == protocol::State::fault);
  CHECK(pose.fault == protocol::Fault::crystal_failed);
  CHECK(bus.violations().empty());
}

}  // namespace inkwell::virtual_usb_test
