// Tests the defects that the RAM march test detects, and the restored content.
#include <doctest/doctest.h>

#include <array>
#include <numeric>

#include "firmware/self_test/ram_pattern.hpp"

namespace {

using namespace inkwell;

/// A word may have stuck bits and a coupling to another word.
struct Word {
  std::uint32_t stored = 0, stuck_high = 0, stuck_low = 0;
  Word* disturbs = nullptr;  ///< each write flips a bit of this word
  Word& operator=(std::uint32_t value) {
    stored = value;
    if (disturbs != nullptr) disturbs->stored ^= 4;
    return *this;
  }
  operator std::uint32_t() const { return (stored | stuck_high) & ~stuck_low; }
};

using Memory = std::array<Word, 10>;

template <class Change>
bool is_intact_with(Change change) {
  Memory memory{};
  change(memory);
  std::array<std::uint32_t, 4> room;
  return link::retains_pattern(std::span<Word>(memory), std::span(room));
}

TEST_CASE("healthy memory retains the pattern and has its previous content afterwards") {
  Memory memory{};
  for (std::uint32_t i = 0; i < memory.size(); ++i) memory[i] = 1000 + i;
  std::array<std::uint32_t, 4> room;
  CHECK(link::retains_pattern(std::span<Word>(memory), std::span(room)));
  for (std::uint32_t i = 0; i < memory.size(); ++i) CHECK(memory[i] == 1000 + i);
}

TEST_CASE("each stuck bit is detected, high or low, in the first, middle and last words") {
  for (const std::size_t index : {std::size_t{0}, std::size_t{3}, std::size_t{4}, std::size_t{9}})
    for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
      CHECK_FALSE(is_intact_with([&](Memory& memory) { memory[index].stuck_high = bit; }));
      CHECK_FALSE(is_intact_with([&](Memory& memory) { memory[index].stuck_low = bit; }));
    }
}

TEST_CASE("the RAM test detects a write that changes the previous or the next word") {
  CHECK_FALSE(is_intact_with([](Memory& memory) { memory[1].disturbs = &memory[2]; }));
  CHECK_FALSE(is_intact_with([](Memory& memory) { memory[2].disturbs = &memory[1]; }));
}

}  // namespace
