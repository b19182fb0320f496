#include <doctest/doctest.h>

#include <cmath>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

constexpr Ticks cycle = 50;  // at 168 MHz
constexpr Ticks pwm_period = 2000 * cycle;

}  // namespace

TEST_SUITE("virtual chip: peripherals") {
  TEST_CASE("TIM1 and TIM8: edges to the cycle, started together, preloaded duty") {
    ChipUnderTest test("pwm");
    test.run_for(0.002);
    REQUIRE(test.result(0) == finished);
    CHECK(test.chip.clocks().hclk_Hz == 168'000'000);
    const auto first = test.circuit.edges_of('A', 8), second = test.circuit.edges_of('C', 6);
    REQUIRE(first.size() > 60);
    REQUIRE(second.size() > 60);

    // In center-aligned PWM mode 1 a pulse lasts twice the duty value. The firmware changes the duty value from 400 to
    // 250.
    std::vector<Ticks> high_times;
    for (std::size_t i = 2; i + 1 < first.size(); ++i) {
      CHECK(first[i].level != first[i - 1].level);
      if (first[i].level == PinLevel::high) high_times.push_back(first[i + 1].when - first[i].when);
    }
    CHECK(high_times.front() == 800 * cycle);
    CHECK(high_times.back() == 500 * cycle);
    // The duty value changes at the bottom of the counter, in the middle of a pulse.
    unsigned mixed = 0;
    for (const Ticks t : high_times) {
      CHECK((t == 800 * cycle || t == 500 * cycle || t == 650 * cycle));
      if (t == 650 * cycle) ++mixed;
    }
    CHECK(mixed == 1);

    // The pulses of the two timers have the same centers.
    const auto rising = [](const std::vector<Edge>& edges, std::size_t from) {
      while (edges[from].level != PinLevel::high) ++from;
      return from;
    };
    const std::size_t i = rising(first, 4), k = rising(second, 4);
    const Ticks middle_1 = (first[i].when + first[i + 1].when) / 2,
                middle_2 = (second[k].when + second[k + 1].when) / 2;
    CHECK((middle_1 > middle_2 ? middle_1 - middle_2 : middle_2 - middle_1) % pwm_period == 0);
    CHECK_FALSE(test.circuit.time_ran_backward);
    CHECK(test.circuit.longest_pause <= ticks(51e-6));
  }

  TEST_CASE("repetition counter: an update every sixth half period, at the bottom") {
    ChipUnderTest test("pwm");
    test.run_for(0.002);
    const std::uint32_t before = test.result(1);
    test.run_for(0.1);
    // Six half periods of 1000 cycles.
    CHECK(test.result(1) - before == 168'000'000 / 10 / 6000);
    for (unsigned n = 0; n < 4; ++n) {
      CHECK(test.result(4 + 2 * n) == 0);  // counting up
      // Exception entry, the first flash lines and an APB access delay the handler's read of the counter.
      CHECK(test.result(5 + 2 * n) < 100);
    }
  }

  TEST_CASE(
      "the break input switches the outputs off immediately without the processor, until the firmware enables them "
      "again") {
    ChipUnderTest test("break_input");
    auto& pins = test.chip.input_pins();
    pins.drive('A', 6, PinLevel::high);
    pins.drive('A', 0, PinLevel::low);
    const auto edges_in = [&](double time_s) {
      test.circuit.edges.clear();
      test.run_for(time_s);
      return test.circuit.edges_of('A', 8);
    };
    CHECK(edges_in(0.001).size() > 50);
    REQUIRE(test.result(0) == finished);
    CHECK(test.result(2) == 1);

    test.circuit.edges.clear();
    // The break occurs in the middle of a pulse, so that an active output is switched off.
    while (test.circuit.edges_of('A', 8).empty() || test.circuit.edges_of('A', 8).back().level != PinLevel::high)
      test.run_for(1e-6);
    const Ticks when = test.chip.now();
    pins.drive('A', 6, PinLevel::low);
    test.run_for(0.001);
    const Edge last = test.circuit.edges_of('A', 8).back();
    CHECK(last.level == PinLevel::low);
    CHECK(last.when >= when);
    CHECK(last.when - when <= 2 * cycle);
    CHECK(test.result(1) == 1);
    CHECK(test.result(2) == 0);

    // MOE cannot be set while the break input is active.
    pins.drive('A', 0, PinLevel::high);
    CHECK(edges_in(0.001).empty());
    pins.drive('A', 6, PinLevel::high);
    CHECK(edges_in(0.001).size() > 10);
    CHECK(test.result(2) == 1);
  }

  TEST_CASE("injected conversions start with the trigger, all three converters at the same instant") {
    ChipUnderTest test("converters");
    test.circuit.voltages = {
        {{'C', 0}, 0.825}, {{'C', 1}, 1.65}, {{'C', 2}, 2.475}, {{'C', 3}, 0.825}, {{'C', 4}, 0.825}};
    std::vector<Ticks> sequences;
    test.chip.on_injected_sequence = [&](std::uint64_t index, Ticks when) {
      CHECK(index == sequences.size());
      sequences.push_back(when);
    };
    test.run_for(0.003);
    REQUIRE(test.result(0) == finished);
    CHECK(test.result(2) == 1024);
    CHECK(test.result(3) == 2048);
    CHECK(test.result(4) == 3072);
    // A conversion of 15 cycles at 21 MHz lasts 60 counts of TIM2; exception entry and the first instructions follow.
    CHECK(test.result(5) >= 60);
    CHECK(test.result(5) < 100);
    REQUIRE(sequences.size() > 50);
    for (std::size_t i = 1; i < sequences.size(); ++i) CHECK(sequences[i] - sequences[i - 1] == ticks(20e-6));
    // The inputs are sampled 3 converter cycles after the trigger.
    unsigned at_once = 0;
    for (const auto& sample : test.circuit.samples)
      if (sample.pin <= 2 && sample.port == 'C' && sample.when == sequences[5] + 3 * 8 * cycle) ++at_once;
    CHECK(at_once == 3);
  }

  TEST_CASE("DMA writes regular conversions to a ring buffer while injected conversions run") {
    ChipUnderTest test("converters");
    test.circuit.voltages = {{{'C', 3}, 0.5}, {{'C', 4}, 3.0}};
    test.run_for(0.003);
    REQUIRE(test.result(6) > 10);
    const auto channel_13 = static_cast<std::uint32_t>(std::floor(0.5 / 3.3 * 4096));
    const auto channel_14 = static_cast<std::uint32_t>(std::floor(3.0 / 3.3 * 4096));
    for (unsigned i = 0; i < 4; ++i) CHECK(test.result(8 + i) == (channel_13 | channel_14 << 16));
    const std::uint32_t before = test.result(6);
    test.run_for(0.01);
    // A conversion lasts 96 cycles at 21 MHz, and a round has 8 conversions. An injected group interrupts a conversion,
    // and the sampling of 84 cycles is repeated.
    const double undisturbed = 0.01 * 21e6 / (96 * 8);
    CHECK(test.result(6) - before < undisturbed);
    CHECK(test.result(6) - before > 0.7 * undisturbed);
  }

  TEST_CASE("the interrupt of a stream occurs after its last transfer, even in fast mode") {
    const auto first_interrupt = [](Mode mode) {
      ChipUnderTest test("converters", mode);
      test.run_for(0.003);
      const auto edges = test.circuit.edges_of('B', 2);
      REQUIRE(edges.size() > 20);
      return edges[1].when;  // the first edge is the switch to output
    };
    CHECK(first_interrupt(Mode::fast) < first_interrupt(Mode::exact) + ticks(1.5e-6));
  }

  TEST_CASE(
      "a conversion contains a part of the previous channel if the source charges the sampling capacitor too slowly") {
    constexpr double switch_ohm = 6000, sampling_F = 4e-12, adc_Hz = 21e6;
    const auto counts = [](double volts) { return volts / 3.3 * 4096; };
    // C3 and C4 are sampled alternately for 84 cycles. C0 is sampled between C3 and C4 for 3 cycles.
    const auto read = [&](AnalogSource source) {
      ChipUnderTest test("converters");
      test.circuit.voltages = {{{'C', 0}, 1.0}, {{'C', 3}, 1.0}, {{'C', 4}, 3.0}};
      test.circuit.sources = {{{'C', 4}, source}};
      test.run_for(0.003);
      const std::uint32_t both = test.result(9);
      CHECK((both & 0xFFFF) == std::floor(counts(1.0)));
      return both >> 16;
    };
    CHECK(read({}) == std::floor(counts(3.0)));
    // With a source of 1 Mohm, the sampling lasts about one time constant.
    const double constant_s = (1e6 + switch_ohm) * sampling_F;
    const double reached_V = 3.0 - 2.0 * std::exp(-84 / adc_Hz / constant_s);
    CHECK(read({1e6, 0.0}) == doctest::Approx(counts(reached_V)).epsilon(0.001));
    // A capacitor at the pin charges the sampling capacitor immediately and loses 4 pF / 1 nF of the 2 V step.
    CHECK(read({1e6, 1e-9}) == doctest::Approx(counts(3.0 - 2.0 * 0.004)).epsilon(0.0003));
    CHECK(read({1e6, 100e-9}) == std::floor(counts(3.0 - 2.0 * 0.00004)));
    // A sampling time of three cycles is six time constants of the sampling switch.
    ChipUnderTest test("converters");
    test.circuit.voltages = {{{'C', 0}, 0.5}, {{'C', 3}, 3.0}, {{'C', 4}, 3.0}};
    test.run_for(0.003);
    const double left_V = 2.5 * std::exp(-3 / adc_Hz / (switch_ohm * sampling_F));
    CHECK(test.result(2) == std::floor(counts(0.5 + left_V)));
    CHECK(test.result(2) > counts(0.5) + 5);
  }

  TEST_CASE("the CRC unit computes Ethernet's polynomial over words, while its clock is on") {
    ChipUnderTest test("checksum", Mode::fast);
    test.run_for(0.001);
    REQUIRE(test.result(0) == finished);
    CHECK(test.result(1) == 0);
    CHECK(test.result(2) == 0xFFFF'FFFF);
    CHECK(test.result(3) == 0xDF8A'8A2B);
    CHECK(test.result(4) == 0xD92B'271B);
    CHECK(test.result(5) == 0xFFFF'FFFF);
    CHECK(test.result(6) == 0xA5);
    CHECK(test.result(7) == 0);
    test.breaks_rules = true;
    REQUIRE(test.chip.violations().size() == 1);
    const Violation& violation = test.chip.violations()[0];
    CHECK(violation.rule == Rule::clock_off);
    CHECK(violation.where == "CRC");
  }

  TEST_CASE("pins, bit-band, identity, flash and USART") {
    ChipUnderTest test("input_output", Mode::fast);
    std::string sent;
    std::vector<Ticks> times;
    test.chip.on_usart = [&](unsigned number, std::uint8_t byte) {
      CHECK(number == 2);
      sent += static_cast<char>(byte);
      times.push_back(test.chip.now());
    };
    test.run_for(0.3);
    REQUIRE(test.result(0) == finished);
    CHECK(sent == "chip\n");
    constexpr Ticks frame = 10 * 365 * 4 * cycle;  // ten bits of 365 cycles of PCLK1
    CHECK(times[2] - times[1] == frame);
    // After 0.6 ms crystal and PLL are stable, and the firmware sends its text.
    CHECK(times[0] < ticks(0.66e-3) + frame);
    CHECK(test.circuit.edges_of('C', 10).back().level == PinLevel::high);
    CHECK(test.result(2) == 1u << 5);
    CHECK(test.result(3) == 0x00310042);
    CHECK(test.result(4) == 1024);
    CHECK(test.result(5) == 0x12345678);
    CHECK(test.result(6) == 0xFFFFFFFF);
    CHECK((test.result(7) & 1u << 7) != 0);

    CHECK(test.result(1) == 0);
    for (int i = 0; i < 3; ++i) {
      test.chip.input_pins().drive('B', 13, PinLevel::low);
      test.run_for(1e-5);
      test.chip.input_pins().drive('B', 13, PinLevel::floating);  // uses the pull-up
      test.run_for(1e-5);
      CHECK(test.result(1) == static_cast<std::uint32_t>(i + 1));
    }
    for (const char c : {'o', 'k'}) test.chip.usart_receive(2, static_cast<std::uint8_t>(c));
    test.run_for(0.001);
    CHECK(test.result(8) == ('o' << 8 | 'k'));
  }

  TEST_CASE("three converters share a DMA stream through the common data register") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("triple_conversion", mode);
      test.circuit.voltages = {{{'C', 0}, 0.5}, {{'C', 1}, 1.0}, {{'C', 2}, 1.5}};
      test.run_for(0.01);
      REQUIRE(test.result(0) == finished);
      constexpr std::uint32_t first = 620, second = 1241, third = 1861;  // of 4096 at 3.3 V
      CHECK(test.result(1) == (second << 16 | first));                   // six half words, one per transfer
      CHECK(test.result(2) == (first << 16 | third));
      CHECK(test.result(3) == (third << 16 | second));
      CHECK(test.result(4) == (second << 16 | first));  // three words
      CHECK(test.result(5) == (first << 16 | third));
      CHECK(test.result(6) == (third << 16 | second));
      const auto low = [](std::uint32_t value) { return value & 0xFF; };
      CHECK((test.result(7) & 0xFFFF) == (low(second) << 8 | low(first)));  // three half words of two results each
      CHECK((test.result(7) >> 16) == (low(first) << 8 | low(third)));
      CHECK((test.result(8) & 0xFFFF) == (low(third) << 8 | low(second)));
      CHECK(test.result(9) == 0);
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("interleaved converters sample one pin in turns until an overrun stops them") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("interleaved", mode);
      test.circuit.voltages = {{{'C', 0}, 1.0}};
      test.run_for(0.01);
      REQUIRE(test.result(0) == finished);
      constexpr std::uint32_t one_volt = 1241;
      for (unsigned i = 0; i < 6; ++i) CHECK(test.result(1 + i) == (one_volt << 16 | one_volt));
      for (unsigned i = 0; i < 3; ++i) CHECK(test.result(9 + i) == (one_volt << 16 | one_volt));
      CHECK(test.result(7) == 0);
      // At 4 MHz the conversions of the first run are five cycles apart. In the second run the conversions are 17
      // cycles apart, which includes 15 cycles of sampling.
      const auto& samples = test.circuit.samples;
      constexpr Ticks cycle = ticks_per_s / 4'000'000;
      REQUIRE(samples.size() > 18);
      for (unsigned i = 1; i < 12; ++i) CHECK(samples[i].when - samples[i - 1].when == 5 * cycle);
      bool slow = false;
      for (std::size_t i = 12; i + 2 < samples.size(); ++i)
        slow |= samples[i + 1].when - samples[i].when == 17 * cycle &&
                samples[i + 2].when - samples[i + 1].when == 17 * cycle;
      CHECK(slow);
      CHECK(samples.size() < 50);  // overrun stopped both runs
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("without a connected device, each peripheral sets the flags or errors that drivers wait for") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("unconnected", mode);
      test.run_for(0.1);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(1) == 1);  // SPI: the frame is complete and contains only ones
      CHECK(test.result(2) == 0xFF);
      CHECK(test.result(3) == 1);
      CHECK(test.result(4) >= 5 * 8 * 8);  // five frames of eight bits at PCLK / 8
      CHECK(test.result(4) < 5 * 8 * 8 + 200);
      CHECK(test.result(5) == 2 * 0xFF);
      CHECK(test.result(6) == 1);  // I2C: the start condition is generated, the address is not acknowledged
      CHECK(test.result(7) == 1);
      CHECK(test.result(8) == 1u << 10);
      CHECK(test.result(9) == 1);
      CHECK(test.result(10) == 1);  // CAN: both modes, then errors up to error passive
      CHECK(test.result(11) == 1);
      CHECK(test.result(12) == 1);
      CHECK(test.result(13) == (128u << 16 | 3u << 4 | 3));
      CHECK(test.result(14) == 1);
      CHECK(test.result(15) == 0x123);  // DAC: immediate, or triggered
      CHECK(test.result(16) == 0);
      CHECK(test.result(17) == 0xABC);
      CHECK(test.result(20) == 1);  // RTC: alarm at midnight before a leap day, a Thursday
      CHECK(test.result(21) == 1);
      CHECK(test.result(22) == 0);
      CHECK(test.result(23) == 0x24'8229);
      CHECK(test.result(24) / 2 == 3);  // wake-up timer every 16 ms
      CHECK(test.result(25) == 0xB0);
      CHECK(test.result(26) == 31);  // write protection is active again
      CHECK(test.log.empty());
    }
  }

  TEST_CASE("a CAN controller in loop-back receives the frames that its filters accept") {
    ChipUnderTest test("can_loop");
    test.run_for(0.1);
    REQUIRE(test.result(0) == finished);
    CHECK(test.result(1) == 2 * 7);
    CHECK(test.result(2) == 0);
    CHECK(test.result(3) == 1);
    CHECK(test.result(4) == 0x123u << 21);
    CHECK(test.result(5) == 5);
    CHECK(test.result(6) == 0x4433'2211);
    CHECK(test.result(7) == 0x55);
    CHECK(test.result(8) == 1);
    CHECK(test.result(9) == 1);
    CHECK(test.result(10) == 3 << 8);  // the fourth identifier of the list
    CHECK(test.result(14) == 4 << 8);  // 32-bit filters have priority over 16-bit filters
    CHECK(test.result(11) == (3 | 1 << 3 | 1 << 4));
    CHECK(test.result(12) == 2);
    CHECK(test.result(13) == 3);
    CHECK(test.log.empty());
  }
}
