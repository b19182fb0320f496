// Tests the motor heat after a restart, with valid and invalid memory contents.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "firmware/exchange/guarded.hpp"
#include "firmware/store/motor_heat_keeper.hpp"

namespace inkwell {
namespace {

using control::Warmth;
using link::MotorHeatKeeper;

constexpr Warmth warm{{0.5f, 0.25f, 1.0f}, {0.25f, 0.125f, 0.75f}, 0};
constexpr Warmth warmer{{0.75f, 0.5f, 1.25f}, {0.5f, 0.375f, 0.875f}, 1};

void check_is(const std::optional<Warmth>& found, const Warmth& expected) {
  REQUIRE(found.has_value());
  CHECK(found->heat == expected.heat);
  CHECK(found->housing == expected.housing);
  CHECK(found->too_hot == expected.too_hot);
}

using Words = std::array<std::uint32_t, sizeof(MotorHeatKeeper) / sizeof(std::uint32_t)>;

struct Memory {
  struct Slot {
    struct Left {
      Warmth warmth;
      std::uint32_t number;
    } left;
    std::uint32_t check;
    void seal() { check = ~link::sum_of(left); }
  };
  std::array<Slot, 2> slots;
  std::uint32_t next_number;
};

MotorHeatKeeper filled_with(std::uint32_t word) {
  Words words;
  words.fill(word);
  return std::bit_cast<MotorHeatKeeper>(words);
}

/// State after power-on.
MotorHeatKeeper fresh() {
  MotorHeatKeeper keeper = filled_with(0x5A5A'5A5A);
  keeper.start(true);
  return keeper;
}

/// Returns the memory after two records; the second record is in the second slot.
Memory memory_with(const Warmth& first, const Warmth& second) {
  MotorHeatKeeper keeper = fresh();
  keeper.store(first);
  keeper.store(second);
  return std::bit_cast<Memory>(keeper);
}

std::optional<Warmth> found_in(const Memory& memory) { return std::bit_cast<MotorHeatKeeper>(memory).start(false); }

}  // namespace

TEST_CASE("motor heat: each start reads the heat that was stored most recently") {
  MotorHeatKeeper keeper = fresh();
  for (const Warmth& warmth : {warm, warmer, warm, warm, warmer}) {
    keeper.store(warmth);
    check_is(keeper.start(false), warmth);
    check_is(keeper.start(false), warmth);
  }
  keeper.store(warm);
  keeper.store(warmer);
  keeper.store(warm);
  check_is(keeper.start(false), warm);
}

TEST_CASE("motor heat: memory content after power-up is ignored") {
  for (const std::uint32_t word : {0u, 0xFFFF'FFFFu, 0x3E3E'3E3Eu, 0x5A5A'5A5Au}) {
    MotorHeatKeeper keeper = filled_with(word);
    CHECK_FALSE(keeper.start(false).has_value());
    keeper.store(warm);
    check_is(keeper.start(false), warm);
  }
}

TEST_CASE("motor heat: a power-on erases it for this start and the later starts") {
  MotorHeatKeeper keeper = std::bit_cast<MotorHeatKeeper>(memory_with(warm, warmer));
  CHECK_FALSE(keeper.start(true).has_value());
  CHECK_FALSE(keeper.start(false).has_value());
  keeper.store(warm);
  check_is(keeper.start(false), warm);
}

TEST_CASE("motor heat: a copy that a restart interrupted is ignored, and the previous copy is used") {
  const auto before = std::bit_cast<Words>(memory_with(warmer, warm));
  MotorHeatKeeper keeper = std::bit_cast<MotorHeatKeeper>(before);
  keeper.store(warmer);
  const auto after = std::bit_cast<Words>(keeper);
  constexpr std::size_t number = 7, check = 8, next_number = 18;
  // The slot already contained the same heat, so only the numbers and the checksum change.
  for (std::size_t word = 0; word < after.size(); ++word)
    CHECK((before[word] != after[word]) == (word == number || word == check || word == next_number));
  // The compiler may write the words in any order.
  for (unsigned written = 0; written < 4; ++written) {
    Words words = before;
    if ((written & 1) != 0) words[number] = after[number];
    if ((written & 2) != 0) words[check] = after[check];
    keeper = std::bit_cast<MotorHeatKeeper>(words);
    check_is(keeper.start(false), written == 3 ? warmer : warm);
    keeper.store(warmer);
    check_is(keeper.start(false), warmer);
  }
  // The test interrupts the storage of a different heat after each word.
  Memory other = memory_with(warm, warmer);
  for (std::size_t end = 1; end < check; ++end) {
    Memory cut = other;
    constexpr Warmth cold{};
    std::memcpy(&cut.slots[0].left, &cold, std::min(4 * end, sizeof cold));
    cut.slots[0].left.number += 2;
    check_is(found_in(cut), warmer);
  }
}

TEST_CASE("motor heat: the first copy after a start does not overwrite the heat that the start read") {
  Memory memory = memory_with(warm, warmer);
  memory.next_number = 0xF000'0001;  // an invalid number, which start() ignores
  auto keeper = std::bit_cast<MotorHeatKeeper>(memory);
  check_is(keeper.start(false), warmer);
  keeper.store(warm);
  check_is(keeper.start(false), warm);
  memory = std::bit_cast<Memory>(keeper);
  CHECK(memory.slots[0].left.number == 2);
  CHECK(memory.slots[1].left.number == 1);
  memory.slots[0].check ^= 1;
  check_is(found_in(memory), warmer);
}

TEST_CASE("motor heat: a bit that has changed in the newest copy leaves the one before it") {
  const auto words = std::bit_cast<Words>(memory_with(warm, warmer));
  for (std::size_t word = 9; word < 18; ++word) {
    Words damaged = words;
    damaged[word] ^= 1u << 3;
    check_is(std::bit_cast<MotorHeatKeeper>(damaged).start(false), warm);
  }
}

TEST_CASE("motor heat: the newest copy is found when the numbers wrap") {
  Memory memory = memory_with(warm, warmer);
  memory.slots[0].left.number = 0;
  memory.slots[1].left.number = 0xFFFF'FFFF;
  for (auto& slot : memory.slots) slot.seal();
  check_is(found_in(memory), warm);
}

TEST_CASE("motor heat: stored values are limited to their range") {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float most = MotorHeatKeeper::most;
  MotorHeatKeeper keeper = fresh();
  keeper.store({{-1e-9f, 0.5f, 225.0f}, {infinity, std::numeric_limits<float>::quiet_NaN(), -infinity}, 1});
  check_is(keeper.start(false), {{0.0f, 0.5f, most}, {most, most, 0.0f}, 1});
}

TEST_CASE("motor heat: a stored value that is outside its range or not a number is ignored") {
  Memory memory = memory_with(warm, warm);
  memory.slots[1].left.warmth = warmer;
  memory.slots[1].seal();
  check_is(found_in(memory), warmer);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {-0.01f, 4.01f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
    for (std::size_t motor = 0; motor < 3; ++motor) {
      for (const auto part : {&Warmth::heat, &Warmth::housing}) {
        Memory damaged = memory;
        (damaged.slots[1].left.warmth.*part)[motor] = wrong;
        damaged.slots[1].seal();
        check_is(found_in(damaged), warm);
      }
    }
  }
}

}  // namespace inkwell
