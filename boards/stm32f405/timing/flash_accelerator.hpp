// Adaptive real-time (ART) accelerator between the core and the flash (RM0090, "Adaptive real-time memory
// accelerator").
#pragma once

#include <array>
#include <cstdint>
#include <vector>
#include "boards/stm32f405/timing/costs.hpp"

namespace inkwell::virtual_board {

/// Cache of 128-bit lines. A new line replaces the least recently used line. The associativity is not documented; the
/// model is fully associative.
class LineCache {
 public:
  /// Creates a cache with `entries` entries (at most 254) for a memory of `lines` lines.
  LineCache(std::size_t entries, std::size_t lines);
  /// Returns true if the line is in the cache, and marks the line as most recently used.
  bool holds(std::uint32_t line) {
    const std::uint8_t entry = entry_of_[line];
    if (entry == 0) return false;
    if (entry != entries_[0].newer) use(entry);
    return true;
  }
  void keep(std::uint32_t line);
  void forget();

 private:
  static constexpr std::uint32_t no_line = ~0u;
  /// Entry of a ring. The ring is in the order of last use. Entry 0 is a sentinel without a line. In the sentinel,
  /// `newer` is the most recently used entry, and `older` is the least recently used entry.
  struct Entry {
    std::uint32_t line = no_line;
    std::uint8_t older = 0, newer = 0;
  };
  void use(std::uint8_t entry);
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> entry_of_;  ///< index: line; 0 means not in the cache
};

class FlashAccelerator {
 public:
  static constexpr std::uint32_t line_bytes = 16;
  static constexpr std::size_t instruction_lines = 64, data_lines = 8;

  /// `flash_bytes` must be a multiple of line_bytes. Addresses are offsets from the start of the flash.
  FlashAccelerator(std::uint32_t flash_bytes, const Costs& costs);

  /// Applies the settings in FLASH_ACR: wait states, prefetch and caches.
  void set(unsigned wait_states, bool prefetch, bool instruction_cache, bool data_cache);
  void forget_instructions() { instructions_.forget(); }  ///< ICRST
  void forget_data() { data_.forget(); }                  ///< DCRST
  /// Call this function after an erase or program operation, because the line buffers of the flash become invalid.
  void forget_lines() { current_ = ahead_ = no_line; }
  /// Returns true if the flash has no wait states.
  bool is_free() const { return wait_states_ == 0; }
  unsigned wait_states() const { return wait_states_; }

  /// Returns the wait cycles at cycle `now` for the instruction line at `offset`.
  unsigned fetch(std::uint32_t offset, std::uint64_t now) {
    const std::uint32_t line = offset / line_bytes;
    if (line == current_) return 0;
    return fetch_other(line, now);
  }
  /// Returns the wait cycles at cycle `now` for data in the line at `offset`.
  unsigned read(std::uint32_t offset, std::uint64_t now);
  /// Returns the wait cycles at cycle `now` for an uncached line.
  unsigned miss(std::uint64_t now) const {
    const bool busy = miss_waits_ && ahead_ != no_line && ahead_at_ > now;
    return static_cast<unsigned>(busy ? ahead_at_ - now : 0) + wait_states_;
  }

 private:
  static constexpr std::uint32_t no_line = ~0u;
  unsigned fetch_other(std::uint32_t line, std::uint64_t now);
  void read_ahead(std::uint32_t line, std::uint64_t now);

  std::uint32_t flash_lines_;
  unsigned wait_states_ = 0;
  bool prefetch_ = false, instruction_cache_ = false, data_cache_ = false;
  const bool prefetch_follows_hit_, keeps_prefetched_, miss_waits_;
  std::uint32_t current_ = no_line;  ///< the most recent instruction line
  std::uint32_t ahead_ = no_line;    ///< the prefetched line
  std::uint64_t ahead_at_ = 0;       ///< time at which the prefetched line is complete
  std::uint32_t current_data_ = no_line;
  LineCache instructions_, data_;
};

}  // namespace inkwell::virtual_board
