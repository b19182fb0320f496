#include <algorithm>
#include <cstring>
#include <timing/cycle_counter.hpp>
#include <utility>

namespace inkwell::virtual_board {

CycleCounter::CycleCounter(Pricing pricing, const CodeMap& map, WordReader word)
    : costs_(pricing),
      map_(map),
      flash_(map.flash_bytes, costs_),
      index_of_flash_(map.flash_bytes / 2),
      index_of_sram_(map.sram_bytes / 2),
      word_(std::move(word)) {}

const BlockPrice& CycleCounter::block(std::uint32_t address, std::span<const std::uint8_t> code) {
  if (forgets_) forget_prices();
  // The flash shows at 0 too.
  const std::uint32_t in_flash = address < map_.flash_bytes ? address : address - map_.flash_base;
  const bool is_flash = in_flash < map_.flash_bytes, is_sram = address - map_.sram_base < map_.sram_bytes;
  std::uint32_t& index = is_flash  ? index_of_flash_[in_flash / 2]
                         : is_sram ? index_of_sram_[(address - map_.sram_base) / 2]
                                   : index_of_others_[address];
  if (index != 0) {
    const Known& known = known_[index - 1];
    const bool same = known.price.bytes == code.size() && known.price.address == address &&
                      (is_flash || std::memcmp(known.code.data(), code.data(), code.size()) == 0);
    if (same) return known.price;
  }
  return remember(index, address, code, is_sram ? CodeMemory::sram : CodeMemory::flash);
}

const BlockPrice& CycleCounter::remember(std::uint32_t& index, std::uint32_t address,
                                         std::span<const std::uint8_t> code, CodeMemory memory) {
  if (index == 0) {
    known_.emplace_back();
    index = static_cast<std::uint32_t>(known_.size());
  }
  Known& known = known_[index - 1];
  known = {price(code, address, memory, costs_, word_), {code.begin(), code.end()}};
  return known.price;
}

unsigned CycleCounter::wait_for(const BlockPrice::Request& request, std::uint64_t now) {
  const std::uint32_t offset = request.address < map_.flash_bytes ? request.address : request.address - map_.flash_base;
  if (offset >= map_.flash_bytes) return 0;
  return request.is_data ? flash_.read(offset, now) : flash_.fetch(offset, now);
}

unsigned CycleCounter::enter(const BlockPrice& block, std::uint64_t now) {
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

void CycleCounter::forget_prices() {
  forgets_ = false;
  std::fill(index_of_flash_.begin(), index_of_flash_.end(), 0u);
  std::fill(index_of_sram_.begin(), index_of_sram_.end(), 0u);
  index_of_others_.clear();
  known_.clear();
}

}  // namespace inkwell::virtual_board
