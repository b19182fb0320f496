// March test of the RAM. Each bit is set and cleared, both before and after its neighbors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::link {

/// Returns true if the memory retains the pattern. The memory contains the pattern afterwards. On a board, `Word` is
/// volatile.
template <class Word>
bool retains_pattern(std::span<Word> memory) {
  constexpr std::uint32_t pattern = 0x5555'5555;  // neighboring bits of a word differ
  bool is_intact = true;
  for (Word& word : memory) word = pattern;
  for (Word& word : memory) {
    is_intact &= word == pattern;
    word = ~pattern;
  }
  for (std::size_t i = memory.size(); i-- > 0;) {
    is_intact &= memory[i] == ~pattern;
    memory[i] = pattern;
  }
  for (const Word& word : memory) is_intact &= word == pattern;
  return is_intact;
}

/// Tests the memory like retains_pattern(memory) and restores the memory content. The size of the buffer `room` limits
/// the words per step.
template <class Word>
bool retains_pattern(std::span<Word> memory, std::span<std::uint32_t> room) {
  bool is_intact = true;
  for (std::size_t done = 0; done < memory.size();) {
    const std::span<Word> part = memory.subspan(done, std::min(room.size(), memory.size() - done));
    for (std::size_t i = 0; i < part.size(); ++i) room[i] = part[i];
    is_intact &= retains_pattern(part);
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = room[i];
    done += part.size();
  }
  return is_intact;
}

}  // namespace inkwell::link
