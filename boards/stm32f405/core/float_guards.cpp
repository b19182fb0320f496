// Hooks for FPU instructions. An FPU instruction raises a fault if the FPU is off or lazy stacking fails.
#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {
namespace {

template <class Function>
void for_each_float_instruction(const AddressSpace& memory, std::uint32_t address, std::uint32_t bytes,
                                Function&& visit) {
  for (std::uint32_t at = address; at < address + bytes;) {
    const std::uint16_t first = memory.half_word(at);
    const bool wide = is_wide(first);
    if (decode(first, wide ? memory.half_word(at + 2) : std::uint16_t{0}, at).uses_float()) visit(at);
    at += wide ? 4 : 2;
  }
}

}  // namespace

bool Processor::has_unguarded_float(std::uint32_t address, std::uint32_t bytes) {
  const auto& block = timing_.block(address, {machine_.memory.at(address, bytes), bytes});
  if (!block.uses_float) return false;
  bool unguarded = false;
  for_each_float_instruction(machine_.memory, address, bytes,
                             [&](std::uint32_t at) { unguarded |= !float_guards_.contains(at); });
  return unguarded;
}

// Unicorn inserts instruction hooks only during translation.
void Processor::guard_float_instructions() {
  for_each_float_instruction(machine_.memory, guard_address_, guard_bytes_, [&](std::uint32_t at) {
    if (!float_guards_.insert(at).second) return;
    uc_hook hook;
    if (uc_hook_add(engine_, &hook, UC_HOOK_CODE, reinterpret_cast<void*>(float_hook), this, at, at) != UC_ERR_OK)
      throw ChipError("The processor emulation (Unicorn) cannot add hooks to FPU instructions.");
  });
  uc_ctl_remove_cache(engine_, std::uint64_t{guard_address_}, std::uint64_t{guard_address_} + guard_bytes_);
  forget_pages();  // as in forget_code()
  guard_bytes_ = 0;
}

void Processor::float_hook(uc_engine*, std::uint64_t address, std::uint32_t, void* pointer) {
  auto& self = *static_cast<Processor*>(pointer);
  if (!self.refuses_float_ || self.stopped_) return;
  self.last_code_address_ = static_cast<std::uint32_t>(address);
  if (!self.float_unit_on_) {
    self.machine_.violations.violate(Rule::float_unit_off);
    self.outcome_ = Outcome::no_coprocessor;
  } else {
    const auto refusal = self.stack_float_context();
    if (!refusal) return;
    self.outcome_ = refusal == Outcome::protected_data ? Outcome::float_context_protected : Outcome::float_context_lost;
  }
  self.stop();
}

bool Processor::lazy_stacking_due() const { return timing_.lazy_stacking_due() || unstacked_float_; }

void Processor::drop_lazy_stacking() {
  timing_.stack_lazily(false);
  set_unstacked_float({});
}

}  // namespace inkwell::virtual_board
