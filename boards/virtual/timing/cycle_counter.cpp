#include <algorithm>
#include <timing/cycle_counter.hpp>
#include <utility>

namespace inkwell::virtual_board {

CycleCounter::CycleCounter(Pricing pricing, const CodeMap& map, WordReader word)
    : costs_(pricing),
      map_(map),
      flash_(map.flash_bytes, costs_),
      known_in_flash_(map.flash_bytes / 2),
      known_in_sram_(map.sram_bytes / 2),
      word_(std::move(word)) {}

CycleCounter::Place CycleCounter::place_of(std::uint32_t address) {
  // The flash shows at 0 too.
  const std::uint32_t in_flash = address < map_.flash_bytes ? address : address - map_.flash_base;
  if (in_flash < map_.flash_bytes) return {&known_in_flash_[in_flash / 2], CodeMemory::flash};
  if (address - map_.sram_base < map_.sram_bytes)
    return {&known_in_sram_[(address - map_.sram_base) / 2], CodeMemory::sram};
  return {&known_elsewhere_[address], CodeMemory::flash};
}

const BlockPrice* CycleCounter::known_block(std::uint32_t address, std::uint32_t bytes) {
  if (forgets_) forget_prices();
  const Known* known = *place_of(address).known;
  const bool fits =
      known != nullptr && known->is_current && known->price.address == address && known->price.bytes == bytes;
  return fits ? &known->price : nullptr;
}

const BlockPrice& CycleCounter::block(std::uint32_t address, std::span<const std::uint8_t> code) {
  if (const auto* known = known_block(address, static_cast<std::uint32_t>(code.size()))) return *known;
  const Place place = place_of(address);
  if (Known* known = *place.known; known != nullptr && known->price.address == address) {
    known->is_current = std::ranges::equal(known->code, code);
    if (known->is_current) return known->price;
  }
  return remember(place, address, code);
}

const BlockPrice& CycleCounter::remember(const Place& place, std::uint32_t address,
                                         std::span<const std::uint8_t> code) {
  Known*& known = *place.known;
  if (known == nullptr) known = &known_.emplace_back();
  *known = {price(code, address, place.memory, costs_, word_), true, {code.begin(), code.end()}};
  return known->price;
}

void CycleCounter::read_anew(std::uint32_t address) {
  if (Known* known = *place_of(address).known) known->is_current = false;
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
  std::fill(known_in_flash_.begin(), known_in_flash_.end(), nullptr);
  std::fill(known_in_sram_.begin(), known_in_sram_.end(), nullptr);
  known_elsewhere_.clear();
  known_.clear();
}

}  // namespace inkwell::virtual_board
