// Encoder mode of the timers: directions, polarities, filters (RM0090, "Encoder interface mode", TIMx_CCMR1).
#include <doctest/doctest.h>

#include <array>
#include <cstring>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

constexpr std::uint32_t tim3 = 0x4000'0400, cr1 = 0x00, smcr = 0x08, sr = 0x10, ccmr1 = 0x18, ccer = 0x20, cnt = 0x24;
constexpr std::uint32_t cc1if = 1 << 1, cc1e = 1 << 0;
constexpr Ticks timer_clock = ticks_per_s / 16'000'000;  ///< the firmware keeps the reset clock

/// TIM3 counts edges of B4 and B5, which are initially low. The firmware records counter and direction continuously.
struct Encoder {
  Encoder() : test("encoder", Mode::fast) {
    for (const unsigned pin : {4, 5}) test.chip.input_pins().drive('B', pin, PinLevel::low);
    test.run_for(0.001);
    REQUIRE(test.result(0) == finished);
    write(cnt, 0);
  }
  void write(std::uint32_t offset, std::uint32_t value) {
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    REQUIRE(test.chip.debug_port().write(tim3 + offset, bytes));
  }
  std::uint32_t read(std::uint32_t offset) {
    std::array<std::uint8_t, 4> bytes;
    REQUIRE(test.chip.debug_port().read(tim3 + offset, bytes));
    std::uint32_t value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  void drive(unsigned pin, bool high, Ticks since) {
    test.chip.input_pins().drive('B', pin, high ? PinLevel::high : PinLevel::low, since);
  }
  /// Generates quadrature edges with the interval `pause`; positive counts are forward.
  void turn(int counts, Ticks pause) {
    constexpr bool a[] = {false, true, true, false}, b[] = {false, false, true, true};
    Ticks when = test.chip.now();
    const Ticks way = static_cast<Ticks>(counts > 0 ? counts : -counts) * pause;
    test.chip.run_until(when + way);
    for (; counts != 0; counts += counts > 0 ? -1 : 1) {
      phase = (phase + (counts > 0 ? 1 : 3)) % 4;
      when += pause;
      drive(4, a[phase], when);
      drive(5, b[phase], when);
    }
  }
  /// Applies a pulse of this length to B4; the pulse starts `phase_of_sampling` after a sample. Returns true if a
  /// rising edge passed the filter.
  bool passes(Ticks length, Ticks sampling, std::int64_t phase_of_sampling) {
    test.chip.run_until(test.chip.now() + 2 * length + 3 * sampling);
    write(sr, 0);
    const Ticks sample = (test.chip.now() - length) / sampling * sampling - sampling;
    const Ticks from = sample + static_cast<Ticks>(phase_of_sampling);
    drive(4, true, from);
    drive(4, false, from + length);
    test.chip.run_until(test.chip.now() + length + 2 * sampling);
    return (read(sr) & cc1if) != 0;
  }
  int count() {
    test.run_for(20e-6);
    return static_cast<std::int16_t>(test.result(1));
  }
  bool counts_down() const { return test.result(2) == 1; }

  ChipUnderTest test;
  int phase = 0;
};

}  // namespace

TEST_SUITE("virtual chip: encoder inputs") {
  TEST_CASE("both edges of both inputs count, both ways, through the wrap") {
    Encoder encoder;
    int total = 0;
    for (const int counts : {1, 7, -3, 1000, -2500, 70'000, -5}) {
      encoder.turn(counts, 3 * timer_clock);
      total += counts;
      CHECK(static_cast<std::int16_t>(encoder.count()) == static_cast<std::int16_t>(total));
      CHECK(encoder.counts_down() == (counts < 0));
    }
  }

  TEST_CASE("modes 1 and 2 count the edges of one input alone") {
    // From two low inputs, forward edges occur on B4, B5, B4, B5.
    struct Row {
      std::uint32_t mode;
      int of_first_edge, of_four;
    };
    for (const Row row : {Row{1, 0, 2}, {2, 1, 2}, {3, 1, 4}}) {
      CAPTURE(row.mode);
      Encoder encoder;
      encoder.write(smcr, row.mode);
      encoder.turn(1, 4 * timer_clock);
      CHECK(encoder.count() == row.of_first_edge);
      encoder.turn(3, 4 * timer_clock);
      CHECK(encoder.count() == row.of_four);
      encoder.turn(-4, 4 * timer_clock);
      CHECK(encoder.count() == 0);
    }
  }

  TEST_CASE("CCxP inverts an input: one of them turns the direction round, both leave it") {
    constexpr std::uint32_t cc1p = 1 << 1, cc2p = 1 << 5;
    struct Row {
      std::uint32_t polarity;
      int forward;
    };
    for (const Row row : {Row{0, 9}, {cc1p, -9}, {cc2p, -9}, {cc1p | cc2p, 9}}) {
      CAPTURE(row.polarity);
      Encoder encoder;
      encoder.write(ccer, row.polarity);
      encoder.turn(9, 4 * timer_clock);
      CHECK(encoder.count() == row.forward);
    }
  }

  TEST_CASE("a stopped timer counts no edge, nor does one that was started later") {
    Encoder encoder;
    encoder.write(cr1, 0);
    encoder.turn(5, 4 * timer_clock);
    CHECK(encoder.count() == 0);
    encoder.write(cr1, 1);
    CHECK(encoder.count() == 0);
    encoder.turn(2, 4 * timer_clock);
    CHECK(encoder.count() == 2);
  }

  TEST_CASE(
      "without a filter, a timer counts slow edges and misses edges that are closer together than its clock period") {
    // Without a filter, the timer misses edges that are closer together than its clock period.
    Encoder slow, fast;
    slow.turn(2000, timer_clock);
    CHECK(slow.count() == 2000);
    fast.turn(2000, timer_clock / 4);
    CHECK(fast.count() < 1000);
  }

  TEST_CASE("ICxF: so many equal samples in a row, at the rate of the code and of CKD") {
    struct Row {
      unsigned code, clock_division;
      Ticks sampling;  ///< in timer clocks
      unsigned samples;
    };
    // Filter codes 1 to 3 sample with the timer clock. Filter codes above 3 sample with the period tDTS, which depends
    // on CKD (RM0090, TIMx_CCMR1).
    for (const Row row : {Row{0, 0, 1, 1}, {0, 2, 4, 1},   {1, 0, 1, 2},   {2, 0, 1, 4},   {3, 0, 1, 8},
                          {3, 2, 1, 8},    {4, 0, 2, 6},   {5, 0, 2, 8},   {6, 0, 4, 6},   {7, 0, 4, 8},
                          {7, 1, 8, 8},    {8, 0, 8, 6},   {9, 0, 8, 8},   {10, 0, 16, 5}, {11, 0, 16, 6},
                          {12, 0, 16, 8},  {13, 0, 32, 5}, {14, 0, 32, 6}, {15, 0, 32, 8}, {15, 2, 128, 8}}) {
      CAPTURE(row.code);
      CAPTURE(row.clock_division);
      Encoder encoder;
      encoder.write(ccer, cc1e);
      encoder.write(cr1, 1 | row.clock_division << 8);
      encoder.write(ccmr1, 0x0101 | row.code << 4 | row.code << 12);
      const Ticks sampling = row.sampling * timer_clock, whole = row.samples * sampling;
      for (const std::int64_t phase : {-1, 0, 1}) {
        CAPTURE(phase);
        CHECK(encoder.passes(whole, sampling, phase));
        if (row.samples > 1) CHECK_FALSE(encoder.passes(whole - sampling, sampling, phase));
        // Whether a pulse of this length passes depends on the phase of the samples.
        CHECK(encoder.passes(whole - sampling + 2, sampling, phase) == (phase <= 0));
      }
      CHECK(encoder.count() == 0);  // each pulse was counted in both directions or not at all
    }
  }

  TEST_CASE("a filter counts every edge of an encoder that leaves it its time, and delays it by that") {
    Encoder encoder;
    constexpr unsigned code = 7, samples = 8, sampling = 4;
    encoder.write(ccmr1, 0x0101 | code << 4 | code << 12);
    // Each input changes its level every two counts.
    constexpr Ticks filter = samples * sampling * timer_clock;
    encoder.turn(500, filter / 2);
    encoder.turn(-300, filter / 2);
    CHECK(encoder.count() == 200);
    encoder.turn(500, filter / 2 - sampling * timer_clock);
    CHECK(encoder.count() < 300);
  }

  TEST_CASE("a pulse between two samples does not restart the sample filter, and a sampled pulse does") {
    constexpr unsigned code = 7, samples = 8;
    constexpr Ticks sampling = 4 * timer_clock;
    for (const bool seen : {false, true}) {
      Encoder encoder;
      encoder.write(ccer, cc1e);
      encoder.write(ccmr1, 0x0101 | code << 4 | code << 12);
      encoder.write(sr, 0);
      encoder.test.run_for(20e-6);
      const Ticks sample = encoder.test.chip.now() / sampling * sampling - 20 * sampling;
      encoder.drive(4, true, sample);
      encoder.drive(4, false, sample + 4 * sampling + (seen ? 0 : 1));
      encoder.drive(4, true, sample + 4 * sampling + 2);
      encoder.drive(4, false, sample + samples * sampling);
      encoder.test.run_for(20e-6);
      CHECK(((encoder.read(sr) & cc1if) != 0) == !seen);
    }
  }
}
