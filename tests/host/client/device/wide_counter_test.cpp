// Extension of the board's 32-bit counters.
#include <doctest/doctest.h>

#include <cstdint>

#include "host/client/device/wide_counter.hpp"

using inkwell::device::WideCounter;

namespace {
constexpr std::int64_t wrap = std::int64_t{1} << 32;
}

TEST_CASE("the first value of a counter counts unchanged, and nearest accepts any value before it") {
  WideCounter counter;
  CHECK(counter.nearest(0xFFFF'FFF0) == wrap - 16);
  CHECK(counter.nearest(5) == 5);
  CHECK(counter.note(0xFFFF'FFF0) == wrap - 16);
}

TEST_CASE("the count continues each time the 32-bit counter wraps") {
  WideCounter counter;
  std::int64_t expected = 0xC000'0000;
  for (int i = 0; i < 20; ++i, expected += 0x3000'0001) {
    CAPTURE(i);
    CHECK(counter.note(static_cast<std::uint32_t>(expected)) == expected);
  }
}

TEST_CASE("values may come out of order, from either side of the wrap") {
  WideCounter counter;
  counter.note(0xFFFF'FFF0);
  CHECK(counter.nearest(3) == wrap + 3);  // a sample that is newer than the newest pose
  CHECK(counter.note(2) == wrap + 2);
  CHECK(counter.nearest(0xFFFF'FFFF) == wrap - 1);  // an event that the previous pose did not contain
  CHECK(counter.note(0xFFFF'FFFF) == wrap - 1);     // the newest value does not decrease
  CHECK(counter.nearest(0x8000'0001) == wrap + 0x8000'0001);
  CHECK(counter.nearest(0x8000'0003) == 0x8000'0003);
}

TEST_CASE("WideCounter returns a negative count for a counter value before the first wrap") {
  WideCounter counter;
  counter.note(4);
  CHECK(counter.nearest(0xFFFF'FFFF) == -1);
  CHECK(WideCounter::at_or_after(4, 3) == wrap + 3);
  CHECK(WideCounter::at_or_after(4, 4) == 4);
}

TEST_CASE("the count of a board continues after a disconnection, and starts again after a restart of the board") {
  WideCounter counter;
  counter.note(1000);
  SUBCASE("it goes on") {
    counter.continue_from(3 * wrap + 900);
    CHECK(counter.note(1020) == 3 * wrap + 1020);
  }
  SUBCASE("it started again") {
    counter.continue_from(3 * wrap + 1001);
    CHECK(counter.note(1020) == 1020);
  }
}
