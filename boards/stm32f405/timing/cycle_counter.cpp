#include "boards/stm32f405/timing/cycle_counter.hpp"
#include <algorithm>
#include <utility>

namespace inkwell::virtual_board {

CycleCounter::CycleCounter(Pricing pricing, const CodeMap& map, WordReader word)
    : costs_(pricing),
      map_(map),
      flash_(map.flash_bytes, costs_),
      known_in_flash_(map.flash_bytes / 2),
      known_in_sram_(map.sram_bytes / 2),
      known_at_zero_(map.sram_bytes / 2),
      word_(std::move(word)) {}

const BlockPrice& CycleCounter::block(std::uint32_t address, std::span<const std::uint8_t> code) {
  if (const auto* known = known_block(address, static_cast<std::uint32_t>(code.size()))) return *known;
  const PriceSlot slot = slot_of(address);
  if (Known* known = *slot.known; known != nullptr && known->price.address == address) {
    known->is_current = std::ranges::equal(known->code, code);
    if (known->is_current) return known->price;
  }
  return remember(slot, address, code);
}

const BlockPrice& CycleCounter::remember(const PriceSlot& slot, std::uint32_t address,
                                         std::span<const std::uint8_t> code) {
  Known*& known = *slot.known;
  if (known == nullptr) known = &known_.emplace_back();
  *known = {true, price(code, address, slot.memory, costs_, word_), {code.begin(), code.end()}};
  return known->price;
}

void CycleCounter::reread(std::uint32_t address) {
  if (Known* known = *slot_of(address).known) known->is_current = false;
}

void CycleCounter::forget_prices() {
  forgets_ = false;
  std::fill(known_in_flash_.begin(), known_in_flash_.end(), nullptr);
  std::fill(known_in_sram_.begin(), known_in_sram_.end(), nullptr);
  std::fill(known_at_zero_.begin(), known_at_zero_.end(), nullptr);
  known_elsewhere_.clear();
  known_.clear();
}

}  // namespace inkwell::virtual_board
