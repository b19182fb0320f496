// A FIFO of 32-bit words in the packet memory of the OTG_FS core.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace inkwell::virtual_board {

constexpr std::uint32_t words_for(std::size_t bytes) { return static_cast<std::uint32_t>((bytes + 3) / 4); }

class WordFifo {
 public:
  /// Largest packet memory of the OTG cores in the STM32F4 family.
  static constexpr std::size_t storage_words = 1024;

  std::size_t count() const { return count_; }
  bool empty() const { return count_ == 0; }
  void clear() { first_ = count_ = 0; }
  void push(std::uint32_t word) { words_[(first_ + count_++) % storage_words] = word; }
  std::uint32_t front() const { return words_[first_]; }
  std::uint32_t at(std::size_t index) const { return words_[(first_ + index) % storage_words]; }
  std::uint32_t pop() {
    const std::uint32_t word = words_[first_];
    drop(1);
    return word;
  }
  void drop(std::size_t words) {
    words = std::min(words, count_);
    first_ = (first_ + words) % storage_words;
    count_ -= words;
  }

 private:
  std::array<std::uint32_t, storage_words> words_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace inkwell::virtual_board
