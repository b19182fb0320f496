// Counts the cycles of the firmware during execution, block by block.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <unordered_map>
#include <vector>
#include "boards/stm32f405/timing/block_price.hpp"
#include "boards/stm32f405/timing/flash_accelerator.hpp"

namespace inkwell::virtual_board {

/// Base addresses and sizes of the two instruction memories.
struct CodeMap {
  /// Memory that is also mapped at address 0.
  enum class AtZero : std::uint8_t { flash, sram, other };
  std::uint32_t flash_base, flash_bytes, sram_base, sram_bytes;
  AtZero at_zero = AtZero::flash;
  /// Returns the offset in the flash, or a value that is not less than `flash_bytes`.
  std::uint32_t flash_offset(std::uint32_t address) const {
    return at_zero == AtZero::flash && address < flash_bytes ? address : address - flash_base;
  }
};

class CycleCounter {
 public:
  /// `word` must read memory without side effects.
  CycleCounter(Pricing pricing, const CodeMap& map, WordReader word);

  const Costs& costs() const { return costs_; }
  FlashAccelerator& flash() { return flash_; }
  const FlashAccelerator& flash() const { return flash_; }

  /// Returns the price of the block at `address`, or null if there is no valid price for `bytes` bytes.
  const BlockPrice* known_block(std::uint32_t address, std::uint32_t bytes) {
    if (forgets_) forget_prices();
    const Known* known = *slot_of(address).known;
    const bool fits =
        known != nullptr && known->is_current && known->price.address == address && known->price.bytes == bytes;
    return fits ? &known->price : nullptr;
  }
  /// Returns the price of the block `code` at `address`. The returned reference is valid while the block runs.
  const BlockPrice& block(std::uint32_t address, std::span<const std::uint8_t> code);
  /// Returns the wait cycles for branch refill and FPU if the block starts at cycle `now`.
  unsigned enter(const BlockPrice& block, std::uint64_t now);
  /// Returns the flash wait cycles of the block if the block starts at cycle `now`. `register_value` returns the value
  /// of a register at cycle `now`. Data reads with an unknown base are not counted. An unknown index is replaced by a
  /// random index into a small table.
  template <class RegisterValue>
  unsigned wait_for_flash(const BlockPrice& block, std::uint64_t now, RegisterValue&& register_value);
  /// Returns the wait cycles of a read at cycle `now`.
  template <class RegisterValue>
  unsigned wait_for(const BlockPrice::Read& read, std::uint64_t now, RegisterValue&& register_value);
  /// Returns the wait cycles of a flash access at cycle `now`.
  unsigned wait_for(const BlockPrice::Request& request, std::uint64_t now);
  /// Maps another memory at address 0.
  void map_at_zero(CodeMap::AtZero memory) {
    map_.at_zero = memory;
    forget();
  }
  /// Call this function when the instruction at `address` may have changed.
  void reread(std::uint32_t address);
  /// Call this function after an exception entry, an exception return or a reset.
  void redirect() { redirected_ = true; }
  /// `due` is true if the next FPU instruction must stack the FPU context of the interrupted code.
  void stack_lazily(bool due) { lazy_stacking_due_ = due; }
  bool lazy_stacking_due() const { return lazy_stacking_due_; }
  /// Call this function when instructions in the flash have changed. The price of the running block stays valid.
  void forget() {
    forgets_ = redirected_ = true;
    flash_.forget_lines();
  }

 private:
  /// The alignment reduces cache misses, because hundreds of blocks run in each control period.
  struct alignas(64) Known {
    bool is_current = false;  ///< the code has not been read again since the pricing
    BlockPrice price;
    std::vector<std::uint8_t> code;  ///< code of the pricing
  };
  struct PriceSlot {
    Known** known;  ///< null means none
    CodeMemory memory;
  };
  PriceSlot slot_of(std::uint32_t address) {
    const std::uint32_t in_flash = map_.flash_offset(address);
    if (in_flash < map_.flash_bytes) return {&known_in_flash_[in_flash / 2], CodeMemory::flash};
    if (address - map_.sram_base < map_.sram_bytes)
      return {&known_in_sram_[(address - map_.sram_base) / 2], CodeMemory::sram};
    if (map_.at_zero == CodeMap::AtZero::sram && address < map_.sram_bytes)
      return {&known_at_zero_[address / 2], CodeMemory::remapped_sram};
    return {&known_elsewhere_[address], CodeMemory::flash};
  }
  const BlockPrice& remember(const PriceSlot& slot, std::uint32_t address, std::span<const std::uint8_t> code);
  void forget_prices();

  bool in_flash(std::uint32_t address) const { return map_.flash_offset(address) < map_.flash_bytes; }
  /// A check for flash reads takes longer than executing the block, so only the first runs and every 64th run are
  /// checked.
  static bool polls_reads(const BlockPrice& block) {
    if (!block.has_reads) return false;
    const std::uint32_t run = block.runs++;
    return block.reads_flash || run < first_polled_runs || run % runs_between_polls == 0;
  }
  /// Pseudo-random substitute for an unknown index into a 1 KiB table. The sequence is repeatable.
  std::uint32_t any_index() {
    random_ = random_ * 1664525 + 1013904223;
    return random_ >> 22 & ~3u;
  }
  static constexpr std::uint32_t first_polled_runs = 4, runs_between_polls = 64;
  Costs costs_;
  CodeMap map_;
  FlashAccelerator flash_;
  std::deque<Known> known_;
  std::vector<Known*> known_in_flash_, known_in_sram_, known_at_zero_;  ///< index: half-word
  std::unordered_map<std::uint32_t, Known*> known_elsewhere_;
  WordReader word_;
  // State at the end of the previous block.
  std::uint32_t last_end_ = 0;
  unsigned last_taken_cycles_ = 0;
  bool redirected_ = true, forgets_ = false;
  std::uint64_t float_ready_ = 0;
  bool lazy_stacking_due_ = false;
  std::uint32_t random_ = 1;
};

inline unsigned CycleCounter::enter(const BlockPrice& block, std::uint64_t now) {
  unsigned waited = 0;
  if (redirected_)
    waited += block.refill_cycles;
  else if (block.address != last_end_)
    waited += last_taken_cycles_ + block.refill_cycles;
  redirected_ = false;
  last_end_ = block.address + block.bytes;
  last_taken_cycles_ = block.taken_cycles;
  if (block.uses_float) {
    if (lazy_stacking_due_) {
      lazy_stacking_due_ = false;
      waited += costs_[Cost::lazy_stacking];
    }
    const std::uint64_t asked = now + waited + block.first_float_cycles;
    if (float_ready_ > asked) waited += static_cast<unsigned>(float_ready_ - asked);
  }
  if (block.float_busy_cycles != 0) float_ready_ = now + waited + block.cycles + block.float_busy_cycles;
  return waited;
}

inline unsigned CycleCounter::wait_for(const BlockPrice::Request& request, std::uint64_t now) {
  const std::uint32_t offset = map_.flash_offset(request.address);
  if (offset >= map_.flash_bytes) return 0;
  return request.is_data ? flash_.read(offset, now) : flash_.fetch(offset, now);
}

template <class RegisterValue>
unsigned CycleCounter::wait_for(const BlockPrice::Read& read, std::uint64_t now, RegisterValue&& register_value) {
  std::uint32_t address = register_value(read.base) + static_cast<std::uint32_t>(read.offset);
  if (read.index != Instruction::no_register) address += register_value(read.index) << read.shift;
  const std::uint32_t offset = map_.flash_offset(address);
  return offset < map_.flash_bytes ? flash_.read(offset, now) : 0;
}

template <class RegisterValue>
unsigned CycleCounter::wait_for_flash(const BlockPrice& block, std::uint64_t now, RegisterValue&& register_value) {
  if (flash_.is_free()) return 0;
  unsigned waited = 0;
  auto request = block.requests.begin();
  const auto read_until = [&](std::uint16_t cycle) {
    for (; request != block.requests.end() && request->after_cycles <= cycle; ++request)
      waited += wait_for(*request, now + waited + request->after_cycles);
  };
  if (polls_reads(block))
    for (const auto& read : block.reads) {
      if (!read.base_at_entry && read.constant == 0) continue;
      const std::uint32_t base = read.base_at_entry ? register_value(read.base) : read.constant;
      if (!in_flash(base)) continue;
      block.reads_flash = true;
      read_until(read.after_cycles);
      const std::uint64_t when = now + waited + read.after_cycles;
      const auto known = [&](std::uint8_t number) {
        return number == read.base ? base : read.index_at_entry ? register_value(number) : any_index();
      };
      waited += wait_for(read, when, known);
    }
  read_until(block.cycles);
  return waited;
}

}  // namespace inkwell::virtual_board
