// Tests injected faults of the chip: late interrupts, stopped converters, stopped DMA, flipped bits, and crystal drift.
#include <array>
#include <cmath>

#include "tests/boards/stm32f405/chip_fixture.hpp"

namespace inkwell::virtual_board::test {
namespace {

constexpr unsigned converters_interrupt = 16 + 18;

/// Returns the address of the first flash half word with this content, or 0.
std::uint32_t find_in_flash(const Chip& chip, std::uint16_t content) {
  for (std::uint32_t address = 0x0800'0000; address < 0x0801'0000; address += 2) {
    const std::uint32_t word = chip.memory_word(address & ~3u);
    if (static_cast<std::uint16_t>((address & 2) != 0 ? word >> 16 : word) == content) return address;
  }
  return 0;
}

TEST_CASE("an exception is late by the injected delay in each period until the delay is cleared") {
  for (const Mode mode : {Mode::exact, Mode::fast}) {
    CAPTURE(static_cast<int>(mode));
    ChipUnderTest test("converters", mode);
    test.run_for(0.003);
    // Delay between conversion trigger and the handler's read, in TIM2 counts at 84 MHz.
    const std::uint32_t in_time = test.result(5);
    test.chip.delay_exception(converters_interrupt, 840);
    test.run_for(0.001);
    const std::uint32_t handled = test.result(1);
    CHECK(test.result(5) == doctest::Approx(in_time + 420).epsilon(0.03));
    test.run_for(0.001);
    CHECK(test.result(1) - handled == doctest::Approx(50).epsilon(0.05));  // each interrupt is handled exactly once
    test.chip.delay_exception(converters_interrupt, 0);
    test.run_for(0.001);
    CHECK(test.result(5) == doctest::Approx(in_time).epsilon(0.05));
  }
}

TEST_CASE("a shorted pin has the level of the short, regardless of the output of the chip") {
  ChipUnderTest test("converters");  // toggles B2
  std::array<unsigned, 3> seen{};
  const auto look = [&] {
    seen.fill(0);
    for (int i = 0; i < 200; ++i) {
      test.run_for(5e-6);
      ++seen[static_cast<std::size_t>(test.chip.pin_level('B', 2))];
    }
  };
  test.run_for(0.003);
  look();
  CHECK(seen[0] > 20);
  CHECK(seen[1] > 20);
  test.chip.input_pins().hold('B', 2, PinLevel::high);
  look();
  CHECK(seen[1] == 200);
  test.chip.input_pins().hold('B', 2, PinLevel::low);
  look();
  CHECK(seen[0] == 200);
  test.chip.input_pins().hold('B', 2, PinLevel::floating);
  look();
  CHECK(seen[1] > 20);
  test.chip.input_pins().hold('Z', 2, PinLevel::low);  // not an existing pin
  test.chip.input_pins().hold('B', 16, PinLevel::low);
}

TEST_CASE("a converter that has stopped starts no conversion; its register keeps the last") {
  ChipUnderTest test("converters");
  test.circuit.voltages = {{{'C', 0}, 0.825}, {{'C', 1}, 1.65}, {{'C', 2}, 2.475}};
  test.run_for(0.003);
  test.chip.stop_converter(2, true);
  // C0 shares its converter with C3 and C4.
  test.circuit.voltages = {{{'C', 0}, 1.65}, {{'C', 1}, 0.825}, {{'C', 2}, 0.825}, {{'C', 3}, 1.65}, {{'C', 4}, 1.65}};
  test.run_for(0.001);
  CHECK(test.result(2) == 2048);
  CHECK(test.result(3) == 2048);  // value from before the fault
  CHECK(test.result(4) == 1024);
  test.chip.stop_converter(2, false);
  test.run_for(0.001);
  CHECK(test.result(3) == 1024);

  const std::uint32_t handled = test.result(1);
  test.chip.stop_converter(1, true);  // its end of conversion triggers the interrupt
  test.run_for(0.001);
  CHECK(test.result(1) - handled <= 1);
}

TEST_CASE("a stopped DMA transfers no data") {
  ChipUnderTest test("converters");
  test.run_for(0.003);
  test.chip.stop_dma(true);
  const std::uint32_t filled = test.result(6);
  test.run_for(0.003);
  CHECK(test.result(6) == filled);
}

TEST_CASE("flip_bit inverts a RAM bit at each call and returns false for an address without memory") {
  ChipUnderTest test("converters");
  test.run_for(0.003);
  constexpr std::uint32_t address = 0x2001'EF02;
  const std::uint32_t before = test.chip.memory_word(0x2001'EF00);
  CHECK(test.chip.flip_bit(address, 5));
  CHECK(test.chip.memory_word(0x2001'EF00) == (before ^ 1u << 21));
  CHECK(test.chip.flip_bit(address, 5));
  CHECK(test.chip.memory_word(0x2001'EF00) == before);
  CHECK_FALSE(test.chip.flip_bit(0x6000'0000, 0));
}

TEST_CASE("after a flash bit flips, the core executes the changed code, although it executed the old code before") {
  for (const Mode mode : {Mode::exact, Mode::fast}) {
    CAPTURE(static_cast<int>(mode));
    ChipUnderTest test("converters", mode);
    test.run_for(0.003);
    const auto asleep = [&] {
      test.run_for(0.0001);
      test.chip.clear_counters();
      test.run_for(0.001);
      return test.chip.counters().sleep_share();
    };
    CHECK(asleep() > 0.3);
    constexpr std::uint16_t wait_for_interrupt = 0xBF30;  // becomes NOP when bits 4 and 5 are inverted
    const std::uint32_t address = find_in_flash(test.chip, wait_for_interrupt);
    REQUIRE(address != 0);
    for (const unsigned bit : {4u, 5u}) CHECK(test.chip.flip_bit(address, bit));
    CHECK(asleep() == 0.0);
    for (const unsigned bit : {4u, 5u}) CHECK(test.chip.flip_bit(address, bit));
    CHECK(asleep() > 0.3);
  }
}

TEST_CASE("a crystal that drifts takes all clocks along") {
  for (const Mode mode : {Mode::fast, Mode::exact}) {
    CAPTURE(static_cast<int>(mode));
    ChipUnderTest test("converters", mode);
    test.run_for(0.003);
    REQUIRE(test.chip.clocks().hclk_Hz == 168'000'000);
    const auto in_a_while = [&] {
      const std::uint32_t handled = test.result(1);
      test.run_for(0.02);
      return test.result(1) - handled;
    };
    CHECK(in_a_while() == doctest::Approx(1000).epsilon(0.0015));
    test.chip.drift_crystal(-10'000);
    CHECK(test.chip.clocks().hclk_Hz == 166'320'000);
    CHECK(in_a_while() == doctest::Approx(990).epsilon(0.0015));
    test.chip.drift_crystal(0);
    CHECK(in_a_while() == doctest::Approx(1000).epsilon(0.0015));
  }
}

}  // namespace
}  // namespace inkwell::virtual_board::test
