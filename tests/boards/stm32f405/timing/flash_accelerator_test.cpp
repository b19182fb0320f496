#include <doctest/doctest.h>

#include "boards/stm32f405/timing/flash_accelerator.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr Costs likely{Pricing::likely}, conservative{Pricing::conservative};
constexpr std::uint32_t flash_bytes = 64 * 1024, line = FlashAccelerator::line_bytes;

/// Reads `lines` flash lines `rounds` times, with `cycles_a_line` cycles per line. Returns the wait cycles of the last
/// round.
unsigned waits_of_loop(FlashAccelerator& flash, unsigned lines, unsigned cycles_a_line, unsigned rounds) {
  std::uint64_t now = 1000;
  unsigned waited = 0;
  for (unsigned round = 0; round < rounds; ++round) {
    waited = 0;
    for (unsigned i = 0; i < lines; ++i) {
      const unsigned wait = flash.fetch(i * line, now);
      waited += wait;
      now += wait + cycles_a_line;
    }
  }
  return waited;
}

TEST_CASE("no wait states, no waits") {
  FlashAccelerator flash(flash_bytes, likely);
  CHECK(flash.is_free());
  CHECK(waits_of_loop(flash, 100, 4, 1) == 0);
}

TEST_CASE("with everything off each other line waits, and the line that was read last does not") {
  FlashAccelerator flash(flash_bytes, likely);
  flash.set(5, false, false, false);
  CHECK(waits_of_loop(flash, 10, 8, 3) == 50);
  CHECK(flash.fetch(9 * line + 4, 5000) == 0);
}

TEST_CASE(
    "with five wait states, prefetch hides the whole wait for eight instructions per flash line and a part for four") {
  for (const bool narrow : {true, false}) {
    FlashAccelerator flash(flash_bytes, likely);
    flash.set(5, true, false, false);
    CHECK(waits_of_loop(flash, 11, narrow ? 8 : 4, 1) == (narrow ? 5 : 5 + 10 * 2));
  }
}

TEST_CASE("a loop of 64 lines runs from the instruction cache, one of 65 never finds its line") {
  for (const bool fits : {true, false}) {
    FlashAccelerator flash(flash_bytes, likely);
    flash.set(5, false, true, false);
    const unsigned lines = fits ? 64 : 65;
    CHECK(waits_of_loop(flash, lines, 4, 3) == (fits ? 0 : 65 * 5));
  }
}

TEST_CASE("emptying the caches makes the first round wait again") {
  FlashAccelerator flash(flash_bytes, likely);
  flash.set(5, false, true, true);
  CHECK(waits_of_loop(flash, 8, 4, 2) == 0);
  CHECK(flash.read(0x4000, 1) == 5);
  CHECK(flash.read(0x4004, 2) == 0);
  flash.forget_instructions();
  flash.forget_data();
  CHECK(waits_of_loop(flash, 8, 4, 1) == 8 * 5);
  CHECK(flash.read(0x4000, 1) == 5);
}

TEST_CASE("the data cache contains eight lines and replaces the least recently used line") {
  FlashAccelerator flash(flash_bytes, likely);
  flash.set(5, false, false, true);
  for (std::uint32_t i = 0; i < 8; ++i) CHECK(flash.read(i * line, 0) == 5);
  CHECK(flash.read(0, 0) == 0);
  CHECK(flash.read(8 * line, 0) == 5);  // replaces line 1
  CHECK(flash.read(0, 0) == 0);
  CHECK(flash.read(1 * line, 0) == 5);
}

TEST_CASE("the conservative figures doubt that a prefetched line enters the cache") {
  FlashAccelerator one(flash_bytes, likely), other(flash_bytes, conservative);
  one.set(5, true, true, true);
  other.set(5, true, true, true);
  CHECK(waits_of_loop(one, 40, 4, 8) == 0);
  CHECK(waits_of_loop(other, 40, 4, 8) == 39 * 2);
}

}  // namespace
}  // namespace inkwell::virtual_board
