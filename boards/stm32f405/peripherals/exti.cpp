#include "boards/stm32f405/peripherals/exti.hpp"

#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {
namespace {
constexpr unsigned lines = exti_map.imr.mr.count;

/// Vector table position of each EXTI line (RM0090, table "Vector table").
constexpr unsigned position_of(unsigned line) {
  constexpr unsigned positions[lines] = {6,  7,  8,  9,  10, 23, 23, 23, 23, 23, 40, 40,
                                         40, 40, 40, 40, 1,  41, 42, 62, 76, 2,  3};
  return positions[line];
}
}  // namespace

void Exti::reset() {
  interrupt_mask_ = event_mask_ = rising_ = falling_ = software_ = pending_ = 0;
  update_interrupts();
}

void Exti::update_interrupts() {
  for (unsigned line = 0; line < lines; ++line)
    machine_.nvic.set_source(position_of(line), line, (pending_ & interrupt_mask_ & 1u << line) != 0);
}

void Exti::edge(unsigned line) {
  const std::uint32_t bit = 1u << line;
  if (((interrupt_mask_ | event_mask_) & bit) == 0) return;
  if ((event_mask_ & bit) != 0) processor_.set_event_register();
  if ((interrupt_mask_ & bit) != 0) {
    pending_ |= bit;
    machine_.nvic.set_source(position_of(line), line, true);
  }
  triggers_.external_line(line);
}

void Exti::pin_changed(unsigned port, unsigned pin, bool high) {
  if (((high ? rising_ : falling_) >> pin & 1) != 0 && syscfg_.port_of(pin) == port) edge(pin);
}

void Exti::internal_line(unsigned line, bool high) {
  const std::uint32_t bit = 1u << line;
  if (((internal_ & bit) != 0) == high) return;
  internal_ ^= bit;
  if (((high ? rising_ : falling_) & bit) != 0) edge(line);
}

std::uint32_t Exti::stored(std::uint32_t offset) const {
  switch (offset) {
    case exti_map.imr: return interrupt_mask_;
    case exti_map.emr: return event_mask_;
    case exti_map.rtsr: return rising_;
    case exti_map.ftsr: return falling_;
    case exti_map.swier: return software_;
    default: return 0;  // PR: writing 1 clears a bit
  }
}

std::uint32_t Exti::read_word(std::uint32_t offset) {
  if (offset == exti_map.pr) {
    machine_.advance_circuit(Machine::input_age_limit);
    return pending_;
  }
  if (offset < exti_map.pr) return stored(offset);
  machine_.log.note("EXTI", offset, false, 0);
  return 0;
}

void Exti::write_word(std::uint32_t offset, std::uint32_t value) {
  value &= exti_map.imr.mr.masks();
  switch (offset) {
    case exti_map.imr: interrupt_mask_ = value; break;
    case exti_map.emr: event_mask_ = value; break;
    case exti_map.rtsr: rising_ = value; break;
    case exti_map.ftsr: falling_ = value; break;
    case exti_map.swier: {
      const std::uint32_t risen = value & ~software_;
      software_ = value;
      for (unsigned line = 0; line < lines; ++line)
        if ((risen >> line & 1) != 0) edge(line);
      break;
    }
    case exti_map.pr:
      pending_ &= ~value;
      software_ &= ~value;
      break;
    default: machine_.log.note("EXTI", offset, true, value); break;
  }
  update_interrupts();
}

std::uint32_t Exti::Syscfg::read_word(std::uint32_t offset) {
  if (offset < bytes) return words_[offset / 4];
  exti_.machine_.log.note("SYSCFG", offset, false, 0);
  return 0;
}

void Exti::Syscfg::reset() {
  words_ = {};
  exti_.processor_.map_at_zero(MemoryAtZero::flash);
}

void Exti::Syscfg::show_boot_loader_chosen() {
  constexpr auto memory = MemoryAtZero::system;
  words_[syscfg_registers.memrmp / 4] = syscfg_registers.memrmp.mem_mode.with(static_cast<std::uint32_t>(memory));
  exti_.processor_.map_at_zero(memory);
}

void Exti::Syscfg::map_at_zero(std::uint32_t mode) {
  constexpr std::uint32_t external_memory = 2;
  if (mode == external_memory)
    exti_.machine_.log.note("SYSCFG memory remap to the FSMC,", syscfg_registers.memrmp, true, mode);
  else
    exti_.processor_.map_at_zero(static_cast<MemoryAtZero>(mode));
}

void Exti::Syscfg::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset == syscfg_registers.memrmp) map_at_zero(syscfg_registers.memrmp.mem_mode.of(value));
  const auto store = [&](std::uint32_t mask) { words_[offset / 4] = value & mask; };
  switch (offset) {
    case syscfg_registers.memrmp: return store(writable(syscfg_registers.memrmp));
    case syscfg_registers.pmc: return store(writable(syscfg_registers.pmc));
    case syscfg_registers.exticr1: return store(writable(syscfg_registers.exticr1));
    case syscfg_registers.exticr2: return store(writable(syscfg_registers.exticr2));
    case syscfg_registers.exticr3: return store(writable(syscfg_registers.exticr3));
    case syscfg_registers.exticr4: return store(writable(syscfg_registers.exticr4));
    case syscfg_registers.cmpcr: return store(writable(syscfg_registers.cmpcr));
    default: return exti_.machine_.log.note("SYSCFG", offset, true, value);
  }
}

}  // namespace inkwell::virtual_board
