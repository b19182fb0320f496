// Tests input captures, external clocks and triggers from other timers (RM0090, "Input capture mode", "Clock
// selection", TIMx_SMCR, TIMx_CCMR1).
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <vector>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

constexpr std::uint32_t tim2 = 0x4000'0000, tim3 = 0x4000'0400, rcc = 0x4002'3800, gpio_d = 0x4002'0C00;
constexpr std::uint32_t cr1 = 0x00, cr2 = 0x04, smcr = 0x08, sr = 0x10, egr = 0x14, ccmr1 = 0x18, ccer = 0x20,
                        cnt = 0x24, psc = 0x28, arr = 0x2C, ccr1 = 0x34;
constexpr std::uint32_t cen = 1 << 0, ug = 1 << 0, cc1if = 1 << 1, cc1e = 1 << 0, cc1_from_its_pin = 1,
                        cc1_from_trigger = 3;
constexpr std::uint32_t etp = 1 << 15, ece = 1 << 14, external_clock_mode_1 = 7, gated = 5, behind_etr = 7 << 4;
constexpr Ticks timer_clock = ticks_per_s / 16'000'000;  ///< the firmware keeps the reset clock

/// TIM3 uses B4 for its first channel and D2 for the external trigger. Both pins are initially low.
struct Inputs {
  Inputs() : test("encoder", Mode::fast) {
    test.chip.input_pins().drive('B', 4, PinLevel::low);
    test.chip.input_pins().drive('D', 2, PinLevel::low);
    test.run_for(0.001);
    REQUIRE(test.result(0) == finished);
    constexpr std::uint32_t ahb1enr = 0x30, apb1enr = 0x40, moder = 0x00, afrl = 0x20;
    write(rcc + ahb1enr, read(rcc + ahb1enr) | 1 << 3);
    write(rcc + apb1enr, read(rcc + apb1enr) | 1 << 0);
    write(gpio_d + moder, 2 << 4);
    write(gpio_d + afrl, 2 << 8);
    write(tim3 + smcr, 0);
    write(tim3 + cr1, 0);
    write(tim3 + cnt, 0);
  }
  void write(std::uint32_t address, std::uint32_t value) {
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    REQUIRE(test.chip.debug_port().write(address, bytes));
  }
  std::uint32_t read(std::uint32_t address) {
    std::array<std::uint8_t, 4> bytes;
    REQUIRE(test.chip.debug_port().read(address, bytes));
    std::uint32_t value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  /// Applies a pulse of this length and level.
  void pulse(char port, unsigned pin, Ticks length = 8 * timer_clock, PinLevel level = PinLevel::high) {
    const PinLevel back = level == PinLevel::high ? PinLevel::low : PinLevel::high;
    const Ticks begin = test.chip.now();
    test.chip.run_until(begin + 2 * length);
    test.chip.input_pins().drive(port, pin, level, begin + length);
    test.chip.input_pins().drive(port, pin, back, begin + 2 * length);
    test.chip.run_until(begin + 3 * length);
  }
  void pulses(char port, unsigned pin, int count) {
    for (int i = 0; i < count; ++i) pulse(port, pin);
  }
  /// Returns the numbers of the pulses on B4 that the first channel captured, starting at 1.
  std::vector<int> captures(int count) {
    std::vector<int> at;
    for (int i = 1; i <= count; ++i) {
      write(tim3 + sr, 0);
      pulse('B', 4);
      if ((read(tim3 + sr) & cc1if) != 0) at.push_back(i);
    }
    return at;
  }

  ChipUnderTest test;
};

}  // namespace

TEST_SUITE("virtual chip: timer inputs") {
  TEST_CASE("ICxPSC: each event, or every second, fourth, eighth is captured") {
    using Captures = std::vector<int>;
    const Captures expected[] = {{1, 2, 3, 4, 5, 6, 7, 8}, {2, 4, 6, 8}, {4, 8}, {8}};
    for (unsigned code = 0; code < 4; ++code) {
      CAPTURE(code);
      Inputs inputs;
      inputs.write(tim3 + ccmr1, cc1_from_its_pin | code << 2);
      inputs.write(tim3 + ccer, cc1e);
      inputs.write(tim3 + cr1, cen);
      CHECK(inputs.captures(8) == expected[code]);
    }
  }

  TEST_CASE("disabling a channel clears the event count of its prescaler") {
    Inputs inputs;
    inputs.write(tim3 + ccmr1, cc1_from_its_pin | 1 << 2);
    inputs.write(tim3 + ccer, cc1e);
    inputs.write(tim3 + cr1, cen);
    CHECK(inputs.captures(1).empty());
    inputs.write(tim3 + ccer, 0);
    inputs.write(tim3 + ccer, cc1e);
    CHECK(inputs.captures(2) == std::vector{2});
  }

  TEST_CASE("the external trigger is a clock in both external modes, divided by ETPS and by the timer's prescaler") {
    struct Row {
      std::uint32_t mode;
      unsigned etps, prescaler;
      std::uint32_t counts;
    };
    for (const Row row : {Row{ece, 0, 0, 16},
                          {ece, 1, 0, 8},
                          {ece, 2, 0, 4},
                          {ece, 3, 0, 2},
                          {ece, 0, 1, 8},
                          {ece, 1, 3, 2},
                          {external_clock_mode_1 | behind_etr, 0, 0, 16},
                          {external_clock_mode_1 | behind_etr, 2, 0, 4},
                          {external_clock_mode_1 | behind_etr | ece, 0, 0, 16}}) {
      CAPTURE(row.mode);
      CAPTURE(row.etps);
      CAPTURE(row.prescaler);
      Inputs inputs;
      inputs.write(tim3 + psc, row.prescaler);
      inputs.write(tim3 + egr, ug);
      inputs.write(tim3 + smcr, row.mode | row.etps << 12);
      inputs.write(tim3 + cr1, cen);
      inputs.pulses('D', 2, 16);
      CHECK(inputs.read(tim3 + cnt) == row.counts);
      inputs.write(tim3 + cr1, 0);
      inputs.pulses('D', 2, 8);
      CHECK(inputs.read(tim3 + cnt) == row.counts);
    }
  }

  TEST_CASE("ETP: falling edges count") {
    for (const bool inverted : {false, true}) {
      CAPTURE(inverted);
      Inputs inputs;
      inputs.write(tim3 + smcr, ece | (inverted ? etp : 0));
      inputs.test.run_for(1e-6);
      inputs.write(tim3 + cnt, 0);
      inputs.write(tim3 + cr1, cen);
      inputs.test.chip.input_pins().drive('D', 2, PinLevel::high, inputs.test.chip.now());
      inputs.test.run_for(1e-6);
      CHECK(inputs.read(tim3 + cnt) == (inverted ? 0 : 1));
      inputs.test.chip.input_pins().drive('D', 2, PinLevel::low, inputs.test.chip.now());
      inputs.test.run_for(1e-6);
      CHECK(inputs.read(tim3 + cnt) == 1);
    }
  }

  TEST_CASE("ETP turns the level at the pin round, which is an edge as any other") {
    Inputs inputs;
    inputs.write(tim3 + smcr, ece);
    inputs.write(tim3 + cr1, cen);
    inputs.write(tim3 + smcr, ece | etp);
    inputs.test.run_for(1e-6);
    CHECK(inputs.read(tim3 + cnt) == 1);
  }

  TEST_CASE("without its divider, the external trigger follows its pin for any earlier state of the divider") {
    Inputs inputs;
    inputs.write(tim3 + smcr, ece | 1 << 12);
    inputs.write(tim3 + cr1, cen);
    inputs.pulse('D', 2);  // the divider output rises and remains high
    CHECK(inputs.read(tim3 + cnt) == 1);
    inputs.write(tim3 + smcr, ece);
    inputs.pulses('D', 2, 3);
    CHECK(inputs.read(tim3 + cnt) == 4);
  }

  TEST_CASE("ETF: the trigger filter ignores a pulse that is shorter than the filter time and counts a longer pulse") {
    Inputs inputs;
    constexpr unsigned eight_samples = 3;
    inputs.write(tim3 + smcr, ece | eight_samples << 8);
    inputs.write(tim3 + cr1, cen);
    inputs.pulse('D', 2, 6 * timer_clock);
    CHECK(inputs.read(tim3 + cnt) == 0);
    inputs.pulse('D', 2, 12 * timer_clock);
    CHECK(inputs.read(tim3 + cnt) == 1);
  }

  TEST_CASE("a counter of external edges continues from its count when its internal clock is selected again") {
    Inputs inputs;
    inputs.write(tim3 + smcr, ece);
    inputs.write(tim3 + cr1, cen);
    inputs.pulses('D', 2, 5);
    inputs.test.run_for(0.001);
    CHECK(inputs.read(tim3 + cnt) == 5);
    inputs.write(tim3 + smcr, 0);
    const auto at_once = inputs.read(tim3 + cnt);
    CHECK(at_once >= 5);
    CHECK(at_once < 100);
    inputs.test.run_for(100e-6);
    CHECK(inputs.read(tim3 + cnt) - at_once == doctest::Approx(1600).epsilon(0.05));
  }

  TEST_CASE("a channel captures by the update of another timer, without any slave mode") {
    Inputs inputs;
    constexpr std::uint32_t update_is_trigger = 2 << 4, itr1_is_tim2 = 1 << 4, period = 500;
    inputs.write(tim3 + smcr, itr1_is_tim2);
    inputs.write(tim3 + ccmr1, cc1_from_trigger);
    inputs.write(tim3 + ccer, cc1e);
    inputs.write(tim3 + arr, 0xFFFF);
    inputs.write(tim3 + cr1, cen);
    inputs.write(tim2 + arr, period - 1);
    inputs.write(tim2 + cr2, update_is_trigger);
    inputs.write(tim2 + egr, ug);
    inputs.write(tim2 + cr1, cen);
    std::vector<std::uint32_t> captured;
    for (int i = 0; i < 6; ++i) {
      inputs.test.chip.run_until(inputs.test.chip.now() + period * timer_clock);
      CHECK((inputs.read(tim3 + sr) & cc1if) != 0);
      captured.push_back(inputs.read(tim3 + ccr1));
    }
    for (std::size_t i = 1; i < captured.size(); ++i) CHECK(captured[i] - captured[i - 1] == period);
    inputs.write(tim3 + ccer, 0);
    inputs.test.run_for(0.001);
    CHECK(inputs.read(tim3 + ccr1) == captured.back());
  }

  TEST_CASE("a channel captures by both edges of the first input") {
    Inputs inputs;
    constexpr std::uint32_t edges_of_input_1 = 4 << 4, cc2_from_trigger = 3 << 8, cc2e = 1 << 4, cc2if = 1 << 2,
                            cc2of = 1 << 10;
    inputs.write(tim3 + smcr, edges_of_input_1);
    inputs.write(tim3 + ccmr1, cc1_from_its_pin | cc2_from_trigger);
    inputs.write(tim3 + ccer, cc2e);
    inputs.write(tim3 + cr1, cen);
    inputs.write(tim3 + sr, 0);
    inputs.pulse('B', 4);
    CHECK((inputs.read(tim3 + sr) & (cc2if | cc2of)) == (cc2if | cc2of));
  }

  TEST_CASE("the trigger gates the external clock") {
    Inputs inputs;
    constexpr std::uint32_t behind_input_1 = 5 << 4;
    inputs.write(tim3 + ccmr1, cc1_from_its_pin);
    inputs.write(tim3 + smcr, ece | gated | behind_input_1);
    inputs.write(tim3 + cr1, cen);
    inputs.pulses('D', 2, 3);
    CHECK(inputs.read(tim3 + cnt) == 0);
    inputs.test.chip.input_pins().drive('B', 4, PinLevel::high, inputs.test.chip.now());
    inputs.test.run_for(1e-6);
    inputs.pulses('D', 2, 3);
    CHECK(inputs.read(tim3 + cnt) == 3);
  }
}
