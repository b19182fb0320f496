#include "boards/stm32f405/timing/flash_accelerator.hpp"
#include <algorithm>

namespace inkwell::virtual_board {

LineCache::LineCache(std::size_t entries, std::size_t lines) : entries_(entries + 1), entry_of_(lines, 0) {
  const std::size_t size = entries_.size();
  for (std::size_t i = 0; i < size; ++i) {
    entries_[i].newer = static_cast<std::uint8_t>((i + 1) % size);
    entries_[i].older = static_cast<std::uint8_t>((i + size - 1) % size);
  }
}

void LineCache::use(std::uint8_t entry) {
  Entry& it = entries_[entry];
  entries_[it.older].newer = it.newer;
  entries_[it.newer].older = it.older;
  it.newer = entries_[0].newer;
  it.older = 0;
  entries_[it.newer].older = entry;
  entries_[0].newer = entry;
}

void LineCache::keep(std::uint32_t line) {
  if (entry_of_[line] != 0) return;
  const std::uint8_t oldest = entries_[0].older;
  if (entries_[oldest].line != no_line) entry_of_[entries_[oldest].line] = 0;
  entries_[oldest].line = line;
  entry_of_[line] = oldest;
  use(oldest);
}

void LineCache::forget() {
  for (Entry& entry : entries_) {
    if (entry.line != no_line) entry_of_[entry.line] = 0;
    entry.line = no_line;
  }
}

FlashAccelerator::FlashAccelerator(std::uint32_t flash_bytes, const Costs& costs)
    : flash_lines_(flash_bytes / line_bytes),
      prefetch_follows_hit_(costs[Cost::prefetch_follows_hit] != 0),
      keeps_prefetched_(costs[Cost::prefetched_line_is_cached] != 0),
      miss_waits_(costs[Cost::miss_waits_for_prefetch] != 0),
      instructions_(instruction_lines, flash_lines_),
      data_(data_lines, flash_lines_) {}

void FlashAccelerator::set(unsigned wait_states, bool prefetch, bool instruction_cache, bool data_cache) {
  wait_states_ = wait_states;
  prefetch_ = prefetch;
  instruction_cache_ = instruction_cache;
  data_cache_ = data_cache;
  if (!prefetch) ahead_ = no_line;
}

void FlashAccelerator::read_ahead(std::uint32_t line, std::uint64_t now) {
  if (!prefetch_ || line >= flash_lines_ || line == ahead_) return;
  ahead_ = line;
  ahead_at_ = now + 1 + wait_states_;
}

unsigned FlashAccelerator::fetch_other(std::uint32_t line, std::uint64_t now) {
  if (wait_states_ == 0) {
    current_ = line;
    return 0;
  }
  if (instruction_cache_ && instructions_.holds(line)) {
    current_ = line;
    if (prefetch_follows_hit_) read_ahead(line + 1, now);
    return 0;
  }
  std::uint64_t there = 0;
  if (prefetch_ && line == ahead_) {
    there = std::max(now, ahead_at_);
    if (instruction_cache_ && keeps_prefetched_) instructions_.keep(line);
  } else {
    there = now + miss(now);
    if (instruction_cache_) instructions_.keep(line);
  }
  current_ = line;
  read_ahead(line + 1, there);
  return static_cast<unsigned>(there - now);
}

unsigned FlashAccelerator::read(std::uint32_t offset, std::uint64_t now) {
  if (wait_states_ == 0) return 0;
  const std::uint32_t line = offset / line_bytes;
  if (data_cache_ && data_.holds(line)) return 0;
  if (!data_cache_ && line == current_data_) return 0;
  current_data_ = line;
  if (data_cache_) data_.keep(line);
  return miss(now);
}

}  // namespace inkwell::virtual_board
