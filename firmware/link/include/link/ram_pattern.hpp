// Whether memory keeps what is written into it: a march, in which each bit goes up and down between its neighbours
// before and after theirs did.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::link {

/// Leaves the pattern behind. `Word` is a volatile word on a board.
template <class Word>
bool keeps_pattern(std::span<Word> memory) {
  constexpr std::uint32_t pattern = 0x5555'5555;  // neighbours in a word differ
  bool is_sound = true;
  for (Word& word : memory) word = pattern;
  for (Word& word : memory) {
    is_sound &= word == pattern;
    word = ~pattern;
  }
  for (std::size_t i = memory.size(); i-- > 0;) {
    is_sound &= memory[i] == ~pattern;
    memory[i] = pattern;
  }
  for (const Word& word : memory) is_sound &= word == pattern;
  return is_sound;
}

/// Puts back what was there, by way of `room`, as many words at a time as it holds.
template <class Word>
bool keeps_pattern(std::span<Word> memory, std::span<std::uint32_t> room) {
  bool is_sound = true;
  for (std::size_t done = 0; done < memory.size();) {
    const std::span<Word> part = memory.subspan(done, std::min(room.size(), memory.size() - done));
    for (std::size_t i = 0; i < part.size(); ++i) room[i] = part[i];
    is_sound &= keeps_pattern(part);
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = room[i];
    done += part.size();
  }
  return is_sound;
}

}  // namespace inkwell::link
