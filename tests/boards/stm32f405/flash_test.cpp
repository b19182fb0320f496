// Tests the duration of flash operations, delayed flash accesses, and power cuts during flash operations.
#include <doctest/doctest.h>

#include <cstring>
#include <set>

#include "boards/stm32f405/core/memory_map.hpp"

#include "tests/boards/stm32f405/chip_fixture.hpp"

namespace inkwell::virtual_board::test {
namespace {

constexpr std::uint32_t store_offset = 0x8000, store_bytes = 0x4000;
constexpr double cycles_per_us = 168.0;

std::uint32_t word_of(Chip& chip, std::uint32_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, chip.flash().data() + offset, sizeof word);
  return word;
}

struct SlowChip {
  explicit SlowChip(bool slowest, std::uint32_t seed = 1) : chip(circuit, options(slowest, seed)) {
    chip.load_elf(firmware_path("flash_times"));
    chip.reset();
  }
  static ChipOptions options(bool slowest, std::uint32_t seed) {
    ChipOptions chosen;
    chosen.slowest_flash = slowest;
    chosen.random_seed = seed;
    chosen.log = [](const std::string&) {};
    return chosen;
  }
  void run_for(double time_s) { chip.run_until(chip.now() + ticks(time_s)); }
  std::uint32_t result(unsigned index) const { return chip.memory_word(0x2001F000 + 4 * index); }
  RecordingCircuit circuit;
  Chip chip;
};

}  // namespace

TEST_SUITE("virtual board: chip") {
  TEST_CASE("during flash erase and programming, code in RAM continues, and each access to the flash waits") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("flash_times", mode);
      test.run_for(0.6);
      REQUIRE(test.result(0) == finished);
      CHECK(test.result(2) / cycles_per_us == doctest::Approx(250'000).epsilon(0.001));
      CHECK(test.result(3) >= 249);  // one per millisecond, without delay
      CHECK(test.result(3) <= 251);
      CHECK(test.result(4) == 0);
      CHECK(test.result(5) / cycles_per_us == doctest::Approx(32).epsilon(0.05));
      CHECK(test.result(6) == 0x0F0F'0000);
      CHECK(test.result(7) == 0x1234'5678);
      // The interrupt reads the flash and waits 230 ms for the end of the erase.
      CHECK(test.result(9) == 0xFFFF'FFFF);
      CHECK(test.result(10) / cycles_per_us == doctest::Approx(230'000).epsilon(0.01));
    }
  }

  TEST_CASE("the slowest flash needs twice the time for an erase, and 100 us for a word") {
    SlowChip test(true);
    test.run_for(1.2);
    REQUIRE(test.result(0) == finished);
    CHECK(test.result(2) / cycles_per_us == doctest::Approx(500'000).epsilon(0.001));
    CHECK(test.result(5) / cycles_per_us == doctest::Approx(200).epsilon(0.05));
  }

  TEST_CASE("a power loss while the flash writes a word leaves some of its bits and changes no other word") {
    std::set<std::uint32_t> left;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
      SlowChip test(false, seed);
      unsigned resets = 0;
      test.chip.on_reset = [&](ResetCause cause) {
        CHECK(cause == ResetCause::power_on);
        if (++resets == 1) test.chip.request_stop();
      };
      // The power is cut while the firmware writes the hundredth word after the second erase.
      test.chip.cut_power_at_flash_operation(5 + 100);
      test.run_for(0.6);
      REQUIRE(resets == 1);
      CHECK(word_of(test.chip, store_offset + 4 * 98) == 0x5A5A'0000 + 98);
      const std::uint32_t torn = word_of(test.chip, store_offset + 4 * 99);
      CHECK((torn & (0x5A5A'0000u + 99)) == 0x5A5A'0000u + 99);
      left.insert(torn);
      CHECK(word_of(test.chip, store_offset + 4 * 100) == 0xFFFF'FFFF);
    }
    CHECK(left.size() > 4);
  }

  TEST_CASE("a power cut in the middle of an erase leaves anything in that sector, and in no other") {
    std::set<std::uint32_t> left;
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
      SlowChip test(false, seed);
      for (const std::uint32_t offset : {store_offset - 4, store_offset, store_offset + store_bytes})
        std::memset(test.chip.flash().data() + offset, 0x11, 4);
      test.chip.on_reset = [&](ResetCause) { test.chip.request_stop(); };
      test.chip.cut_power_at_flash_operation(1);
      test.run_for(0.3);
      left.insert(word_of(test.chip, store_offset));
      CHECK(word_of(test.chip, store_offset - 4) == 0x1111'1111);
      CHECK(word_of(test.chip, store_offset + store_bytes) == 0x1111'1111);
    }
    CHECK(left.size() > 2);
    CHECK(left.contains(0x1111'1111));
  }

  TEST_CASE("an image replaces the sectors that it needs, and the others stay") {
    SlowChip test(false);
    test.chip.flash()[store_offset] = 0x5A;
    test.chip.flash()[0x3000] = 0x5A;  // after the image, in its last sector
    test.chip.load_elf(firmware_path("flash_times"));
    CHECK(test.chip.flash()[store_offset] == 0x5A);
    CHECK(test.chip.flash()[0x3000] == 0xFF);
  }
}

}  // namespace inkwell::virtual_board::test
