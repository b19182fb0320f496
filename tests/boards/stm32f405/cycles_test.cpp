// Compares the cycle counts of exact and fast mode with the manuals.
#include <doctest/doctest.h>

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

struct Measured : ChipUnderTest {
  explicit Measured(Mode mode, Pricing pricing = Pricing::likely) : ChipUnderTest("cycles", mode, pricing) {
    run_for(0.1);
    REQUIRE(result(0) == finished);
  }
};

}  // namespace

TEST_SUITE("virtual chip: cycles") {
  TEST_CASE("instructions take the cycles of the manuals if the memory has no wait states") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      const Measured test(mode);
      // In exact mode a time slice may end between two loads and prevent their pipelining.
      const auto about = [](double cycles) { return doctest::Approx(cycles).epsilon(0.02); };
      CHECK(test.result(1) == about(32));      // additions
      CHECK(test.result(2) == about(32));      // 32-bit instructions: one word per cycle equals the fetch rate of the
                                               // core
      CHECK(test.result(3) == about(32 * 4));  // two pipelined loads take three cycles
      CHECK(test.result(4) == about(32 * 2));
      CHECK(test.result(5) == about(32 * 5));  // the previous instruction computes the address
      CHECK(test.result(6) == about(32 * 2));  // a sum that the next instruction uses
      CHECK(test.result(7) == about(32 * 2));  // two alternating sums
      CHECK(test.result(8) == about(32 * 3));
      CHECK(test.result(9) == about(32 * 5));  // 1 / 1: a quotient of one bit
    }
  }

  TEST_CASE("a read of a register waits for its bus, two cycles of that bus and longer") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      const Measured test(mode);
      const double ahb = test.result(18), apb_at_full_rate = test.result(19), apb_at_a_quarter = test.result(20);
      CHECK(ahb == doctest::Approx(32 * 4).epsilon(0.02));
      CHECK(apb_at_full_rate == doctest::Approx(32 * (3 + 1 + 2)).epsilon(0.02));
      // An access takes 3 + 1 + 2 * 4 = 12 cycles, a multiple of 4, so exact mode needs no alignment cycles.
      CHECK(apb_at_a_quarter >= 32 * 12);
      CHECK(apb_at_a_quarter <= 32 * (12 + 3));
    }
  }

  TEST_CASE("constants in flash: each read of another line waits unless the data cache holds it") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      const Measured test(mode);
      const double no_wait = test.result(21), waiting = test.result(22), cached = test.result(23);
      CHECK(no_wait == doctest::Approx(32 * 4).epsilon(0.02));
      CHECK(waiting == doctest::Approx(32 * (4 + 2 * 5)).epsilon(0.02));
      CHECK(cached == doctest::Approx(32 * 4).epsilon(0.02));
    }
  }

  TEST_CASE("prefetch reduces the flash wait, and the cache removes the wait for code that fits") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      const Measured test(mode);
      const double no_wait = test.result(10), off = test.result(11), prefetch = test.result(12), all = test.result(13);
      // Four 32-bit instructions per flash line take 4 cycles without wait states, 9 cycles with wait states and 6
      // cycles with prefetch.
      CHECK(no_wait == doctest::Approx(3 * 1024).epsilon(0.01));
      CHECK(off / no_wait == doctest::Approx(9.0 / 4).epsilon(0.02));
      CHECK(prefetch / no_wait == doctest::Approx(6.0 / 4).epsilon(0.02));
      CHECK(all / no_wait == doctest::Approx(6.0 / 4).epsilon(0.02));
      const double short_no_wait = test.result(14), short_off = test.result(15), short_all = test.result(17);
      CHECK(short_off > 2 * short_no_wait);
      CHECK(short_all == doctest::Approx(short_no_wait).epsilon(0.02));
    }
  }

  TEST_CASE("the conservative pricing never counts noticeably less") {
    const Measured likely(Mode::fast), conservative(Mode::fast, Pricing::conservative);
    for (unsigned i = 1; i < 24; ++i) {
      CAPTURE(i);
      // Assumptions about unspecified cache behavior can change the cycle count of a loop in either direction.
      CHECK(conservative.result(i) >= 0.99 * likely.result(i));
    }
  }
}
