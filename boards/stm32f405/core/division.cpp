// Raises a fault at a division by zero if CCR.DIV_0_TRP is set (ARMv7-M, A7.7.127 and B3.2.8). Unicorn itself raises no
// fault and returns 0 as the quotient.
#include <utility>

#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {

bool Processor::divides_by_zero(std::uint32_t address) const {
  const std::uint16_t first = machine_.memory.half_word(address), second = machine_.memory.half_word(address + 2);
  const bool divides = (first & 0xFFD0) == 0xFB90 && (second & 0xF0F0) == 0xF0F0;  // SDIV, UDIV
  if (!divides || register_reader()(second & 0xF) != 0) return false;
  // Unicorn cannot be stopped in an if-then block. A division by zero in an if-then block therefore raises no fault.
  if (machine_.options.mode == Mode::exact) return !in_if_then_block(address);
  for (std::uint32_t at = last_code_address_; at < address; at += is_wide(machine_.memory.half_word(at)) ? 4 : 2)
    if (if_then_block_covers(at, address)) return false;
  return true;
}

bool Processor::has_new_divides(const BlockPrice& block) {
  for (const auto& divide : block.divides)
    if (hooked_divides_.insert(divide.address).second) new_divides_.push_back(divide.address);
  return !new_divides_.empty();
}

void Processor::hook_new_divides() {
  for (const std::uint32_t address : std::exchange(new_divides_, {})) {
    uc_hook hook = 0;
    uc_hook_add(engine_, &hook, UC_HOOK_CODE, reinterpret_cast<void*>(divide_hook), this, address, address);
    forget_code(address, 4);  // code translated before this point does not call the hook
  }
}

void Processor::divide_hook(uc_engine*, std::uint64_t address, std::uint32_t, void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  if (!self.machine_.traps_zero_division || !self.divides_by_zero(static_cast<std::uint32_t>(address))) return;
  self.outcome_ = Outcome::division_by_zero;
  self.stop();
}

}  // namespace inkwell::virtual_board
