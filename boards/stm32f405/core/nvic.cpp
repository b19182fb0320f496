#include "boards/stm32f405/core/nvic.hpp"

#include <algorithm>
#include <bit>

#include "boards/stm32f405/core/system_map.hpp"

namespace inkwell::virtual_board {

void Nvic::reset() {
  pending_ = active_ = held_ = {};
  priority_.fill(0);
  level_.fill(0);
  group_ = 0;
  enabled_ = {};
  // NMI, HardFault, SVCall, PendSV and SysTick have no enable bit. The enable bits of the three configurable faults are
  // in SHCSR.
  for (const unsigned always :
       {exception_nmi, exception_hard_fault, exception_svcall, exception_pendsv, exception_systick})
    assign(enabled_, always, true);
  non_maskable_ = false;
  changed_ = true;
  newly_pending_ = false;
}

void Nvic::pend(unsigned exception) {
  if (test(pending_, exception)) return;
  assign(pending_, exception, true);
  if (test(late_, exception) && !test(held_, exception)) {
    assign(held_, exception, true);
    on_held(exception);
  }
  changed_ = true;
  newly_pending_ = true;
}

void Nvic::unpend(unsigned exception) { assign(pending_, exception, false); }

void Nvic::set_source(unsigned position, unsigned source, bool asserted) {
  if (position >= positions) return;
  const std::uint32_t before = level_[position];
  level_[position] = asserted ? before | 1u << source : before & ~(1u << source);
  const unsigned exception = exception_interrupt_0 + position;
  if (before == 0 && level_[position] != 0 && !active(exception)) pend(exception);
}

void Nvic::enter(unsigned exception) {
  assign(pending_, exception, false);
  assign(active_, exception, true);
}

void Nvic::leave(unsigned exception) {
  assign(active_, exception, false);
  if (exception >= exception_interrupt_0 && level_[exception - exception_interrupt_0] != 0) pend(exception);
  if (exception == exception_nmi && non_maskable_) pend(exception);
  changed_ = true;
}

unsigned Nvic::active_count() const {
  return static_cast<unsigned>(std::popcount(active_[0]) + std::popcount(active_[1]));
}

int Nvic::group_priority(unsigned exception) const {
  if (exception == exception_hard_fault) return -1;
  if (exception == exception_nmi) return -2;
  // The priority bits above bit PRIGROUP are the group priority (ARMv7-M, "Priority grouping").
  return priority_[exception] & (0xFF << (group_ + 1) & 0xFF);
}

int Nvic::execution_priority(const Masks& masks) const {
  int priority = priority_lowest;
  for (unsigned half = 0; half < 2; ++half)
    for (std::uint64_t bits = active_[half]; bits != 0; bits &= bits - 1)
      priority = std::min(priority, group_priority(half * 64 + static_cast<unsigned>(std::countr_zero(bits))));
  if (masks.basepri != 0)
    priority = std::min(priority, static_cast<int>(masks.basepri & (0xFFu << (group_ + 1)) & 0xFF));
  if (masks.primask) priority = std::min(priority, 0);
  if (masks.faultmask) priority = std::min(priority, -1);
  return priority;
}

unsigned Nvic::most_urgent() const {
  unsigned best = exception_none;
  int best_group = priority_lowest, best_full = priority_lowest;
  for (unsigned half = 0; half < 2; ++half)
    for (std::uint64_t bits = pending_[half] & enabled_[half] & ~lost_[half] & ~held_[half]; bits != 0;
         bits &= bits - 1) {
      const unsigned exception = half * 64 + static_cast<unsigned>(std::countr_zero(bits));
      const int group = group_priority(exception);
      const int full = group < 0 ? group : priority_[exception];
      // At equal priorities the exception with the lower number wins.
      if (group < best_group || (group == best_group && full < best_full)) {
        best = exception;
        best_group = group;
        best_full = full;
      }
    }
  return best;
}

unsigned Nvic::next(const Masks& masks) const {
  const unsigned best = most_urgent();
  return best != exception_none && group_priority(best) < execution_priority(masks) ? best : unsigned{exception_none};
}

std::uint32_t Nvic::word_of(const Bits& bits, unsigned index) const {
  const unsigned first = exception_interrupt_0 + 32 * index;
  std::uint32_t word = 0;
  for (unsigned i = 0; i < 32 && first + i < exception_numbers; ++i)
    if (test(bits, first + i)) word |= 1u << i;
  return word;
}

std::uint32_t Nvic::read(std::uint32_t offset) const {
  const auto& map = nvic_registers;
  if (offset >= map.ipr) {
    std::uint32_t word = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned position = (offset - map.ipr) / 4 * 4 + i;
      if (position < positions) word |= std::uint32_t{priority_[exception_interrupt_0 + position]} << 8 * i;
    }
    return word;
  }
  const unsigned index = offset / 4 % 8;
  if (offset >= map.iabr) return word_of(active_, index);
  if (offset >= map.ispr) return word_of(pending_, index);
  return word_of(enabled_, index);
}

void Nvic::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  const auto& map = nvic_registers;
  if (offset >= map.ipr) {
    for (unsigned i = 0; i < size; ++i) {
      const unsigned position = offset - map.ipr + i;
      if (position < positions)
        set_priority(exception_interrupt_0 + position, static_cast<std::uint8_t>(value >> 8 * i));
    }
    return;
  }
  constexpr std::uint32_t bank_bytes = nvic_registers.icer - nvic_registers.iser;
  const unsigned first = exception_interrupt_0 + 32 * (offset % bank_bytes / 4);
  for (std::uint32_t bits = value; bits != 0; bits &= bits - 1) {
    const unsigned exception = first + static_cast<unsigned>(std::countr_zero(bits));
    if (exception >= exception_numbers) return;
    switch (offset / bank_bytes * bank_bytes) {
      case nvic_registers.iser: enable(exception, true); break;
      case nvic_registers.icer: enable(exception, false); break;
      case nvic_registers.ispr: pend(exception); break;
      case nvic_registers.icpr:
        unpend(exception);
        // If the interrupt line is still asserted, the interrupt becomes pending again immediately.
        if (level_[exception - exception_interrupt_0] != 0 && !active(exception)) pend(exception);
        break;
      default: break;
    }
  }
}

}  // namespace inkwell::virtual_board
