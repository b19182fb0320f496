// Tests which peripherals stop while a debug probe halts the core (RM0090, "Debug support for timers, watchdog, bxCAN
// and I2C").
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

constexpr std::uint32_t stop_rtc = 1 << 10, stop_can_1 = 1 << 25, nothing = 0;
constexpr double halt_s = 0.02;

/// Progress of the peripherals during the halt.
struct Moved {
  std::uint32_t systick_counts, rtc_cycles, wake_ups, can_frames;
};

Moved moved_by_halt(std::uint32_t stops) {
  ChipUnderTest test("halted", Mode::fast);
  std::array<std::uint8_t, 4> bytes;
  std::memcpy(bytes.data(), &stops, sizeof stops);
  constexpr std::uint32_t asked_stops = 0x2001'F000 + 4 * 20;
  REQUIRE(test.chip.debug_port().write(asked_stops, bytes));
  test.run_for(0.05);
  REQUIRE(test.result(0) == finished);
  test.run_for(100e-6);
  const auto at = [&](unsigned index) { return test.result(index); };
  const std::array before{at(1), at(2), at(3), at(4)};
  test.chip.halt(ticks(halt_s));
  test.run_for(halt_s + 50e-6);
  CHECK(test.log.empty());
  return {before[0] - at(1), before[1] - at(2), at(3) - before[2], at(4) - before[3]};
}

}  // namespace

TEST_SUITE("virtual chip: debugger halt") {
  TEST_CASE("a halt of the core stops SysTick, but not the RTC and CAN") {
    const Moved moved = moved_by_halt(nothing);
    CHECK(moved.systick_counts < 2'000);  // at 16 MHz: counts outside the halt
    CHECK(moved.rtc_cycles >= 640);
    CHECK(moved.wake_ups == 1);
    CHECK(moved.can_frames == 1);
  }

  TEST_CASE("DBG_RTC_STOP stops calendar and wake-up timer where they are") {
    const Moved moved = moved_by_halt(stop_rtc);
    CHECK(moved.rtc_cycles <= 3);
    CHECK(moved.wake_ups == 0);
    CHECK(moved.can_frames == 1);
  }

  TEST_CASE("DBG_CAN1_STOP with CAN_MCR.DBF lets no frame pass") {
    const Moved moved = moved_by_halt(stop_can_1);
    CHECK(moved.can_frames == 0);
    CHECK(moved.rtc_cycles >= 640);
  }
}
