#include "system_control.hpp"

#include "processor.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t control_space = 0xE000'E000;
constexpr std::uint32_t trace_cell_base = 0xE000'1000, stimulus_end = 0xE000'1000;
constexpr std::uint32_t cycle_counter_enable = 1, trace_enable = 1u << 24;

/// System handlers 4..15 have their priorities in SHPR1..3.
constexpr std::uint32_t first_handler_priority = 0xE000'ED18, last_handler_priority = 0xE000'ED23;

struct HandlerBit {
  unsigned bit;
  unsigned exception;
};
// SHCSR (ARMv7-M, B3.2.13).
constexpr HandlerBit active_bits[] = {{0, 4}, {1, 5}, {3, 6}, {7, 11}, {8, 12}, {10, 14}, {11, 15}};
constexpr HandlerBit pending_bits[] = {{12, 6}, {13, 4}, {14, 5}, {15, 11}};
constexpr HandlerBit enable_bits[] = {{16, 4}, {17, 5}, {18, 6}};

}  // namespace

SystemControl::SystemControl(Machine& machine) : machine_(machine), systick_(machine) {}

void SystemControl::reset() {
  vector_table_ = sleep_control_ = reset_control_ = 0;
  configuration_ = 0x200;
  configurable_faults_ = hard_faults_ = debug_faults_ = 0;
  memory_fault_address_ = bus_fault_address_ = auxiliary_faults_ = 0;
  coprocessor_access_ = auxiliary_control_ = 0;
  float_control_ = 0xC000'0000;
  float_address_ = float_default_ = 0;
  debug_monitor_ = 0;
  trace_control_ = 0x4000'0000;
  cycle_base_ = cycle_held_ = 0;
  debug_freeze_ = {};
  systick_.reset();
}

void SystemControl::record_fault(std::uint32_t configurable_bits, std::uint32_t hard_fault_bits) {
  configurable_faults_ |= configurable_bits;
  hard_faults_ |= hard_fault_bits;
}

std::uint32_t SystemControl::cycle_count() const {
  if ((trace_control_ & cycle_counter_enable) == 0) return cycle_held_;
  // The core's clock stands still in sleep, unless the debugger keeps it on (DBGMCU_CR.DBG_SLEEP).
  const std::uint64_t cycles = machine_.processor->cycles() + machine_.processor->slept_cycles();
  return static_cast<std::uint32_t>(cycles) - cycle_base_;
}

std::uint32_t SystemControl::interrupt_control_state() const {
  const auto& nvic = machine_.nvic;
  const unsigned urgent = nvic.most_urgent();
  std::uint32_t value = machine_.processor->current_exception() | urgent << 12;
  if (nvic.active_count() <= 1) value |= 1u << 11;  // RETTOBASE
  if (urgent >= exception_interrupt_0) value |= 1u << 22;
  if (nvic.pending(exception_systick)) value |= 1u << 26;
  if (nvic.pending(exception_pendsv)) value |= 1u << 28;
  if (nvic.pending(exception_nmi)) value |= 1u << 31;
  return value;
}

void SystemControl::write_interrupt_control_state(std::uint32_t value) {
  auto& nvic = machine_.nvic;
  if ((value & 1u << 25) != 0) nvic.unpend(exception_systick);
  if ((value & 1u << 26) != 0) nvic.pend(exception_systick);
  if ((value & 1u << 27) != 0) nvic.unpend(exception_pendsv);
  if ((value & 1u << 28) != 0) nvic.pend(exception_pendsv);
  if ((value & 1u << 31) != 0) nvic.pend(exception_nmi);
}

void SystemControl::write_reset_control(std::uint32_t value) {
  if (value >> 16 != 0x05FA) return;  // VECTKEY
  machine_.nvic.set_priority_group(value >> 8 & 7);
  if ((value & 1u << 2) != 0) machine_.request_reset(ResetCause::software);
}

std::uint32_t SystemControl::handler_control_state() const {
  std::uint32_t value = 0;
  for (const auto& b : active_bits) value |= static_cast<std::uint32_t>(machine_.nvic.active(b.exception)) << b.bit;
  for (const auto& b : pending_bits) value |= static_cast<std::uint32_t>(machine_.nvic.pending(b.exception)) << b.bit;
  for (const auto& b : enable_bits) value |= static_cast<std::uint32_t>(machine_.nvic.enabled(b.exception)) << b.bit;
  return value;
}

void SystemControl::write_handler_control_state(std::uint32_t value) {
  for (const auto& b : active_bits) machine_.nvic.set_active(b.exception, (value >> b.bit & 1) != 0);
  for (const auto& b : enable_bits) machine_.nvic.enable(b.exception, (value >> b.bit & 1) != 0);
  for (const auto& b : pending_bits)
    if ((value >> b.bit & 1) != 0)
      machine_.nvic.pend(b.exception);
    else
      machine_.nvic.unpend(b.exception);
}

std::uint32_t SystemControl::read_word(std::uint32_t address) {
  if (address < stimulus_end) return (address & 0xFFF) < 0x400 ? 1 : 0;  // ITM: stimulus ports always ready
  if (address <= trace_cell_base + 4 && (debug_monitor_ & trace_enable) == 0) return 0;  // DEMCR.TRCENA powers the DWT
  switch (address) {
    case trace_cell_base: return trace_control_;
    case trace_cell_base + 4: return cycle_count();
    case 0xE000'E004: return 2;  // ICTR: interrupt lines in groups of 32
    case 0xE000'E008: return auxiliary_control_;
    case 0xE000'ED00: return 0x410F'C241;  // CPUID: Cortex-M4 r0p1
    case 0xE000'ED04: return interrupt_control_state();
    case 0xE000'ED08: return vector_table_;
    case 0xE000'ED0C: return 0xFA05'0000 | machine_.nvic.priority_group() << 8;
    case 0xE000'ED10: return sleep_control_;
    case 0xE000'ED14: return configuration_;
    case 0xE000'ED24: return handler_control_state();
    case 0xE000'ED28: return configurable_faults_;
    case 0xE000'ED2C: return hard_faults_;
    case 0xE000'ED30: return debug_faults_;
    case 0xE000'ED34: return memory_fault_address_;
    case 0xE000'ED38: return bus_fault_address_;
    case 0xE000'ED3C: return auxiliary_faults_;
    case 0xE000'ED88: return coprocessor_access_;
    case 0xE000'EDF0: return 0;  // DHCSR: no debugger
    case 0xE000'EDFC: return debug_monitor_;
    case 0xE000'EF34: return float_control_;
    case 0xE000'EF38: return float_address_;
    case 0xE000'EF3C: return float_default_;
    case 0xE000'EF40: return 0x1011'0021;  // MVFR0, MVFR1: FPv4-SP
    case 0xE000'EF44: return 0x1100'0011;
    case 0xE004'2000: return 0x1007'6413;  // DBGMCU_IDCODE: STM32F405, revision 1
    case 0xE004'2004: return machine_.sleep_counts_cycles ? 1 : 0;
    case 0xE004'2008:
    case 0xE004'200C: return debug_freeze_[(address - 0xE004'2008) / 4];
    default: break;
  }
  if (address >= first_handler_priority && address <= last_handler_priority) {
    const unsigned first = 4 + (address - first_handler_priority);
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{machine_.nvic.priority(first + i)} << 8 * i;
    return value;
  }
  if (address >= 0xE000'E010 && address <= 0xE000'E01C) return systick_.read(address - 0xE000'E010);
  if (address >= 0xE000'E100 && address < 0xE000'E500) return machine_.nvic.read(address - control_space);
  machine_.log.note("private peripheral bus 0xE0000000", address & 0xFFFFF, false, 0);
  return 0;
}

std::uint32_t SystemControl::read(std::uint32_t address, unsigned size) {
  const std::uint32_t word = read_word(address & ~3u);
  return size == 4 ? word : word >> 8 * (address & 3) & (size == 1 ? 0xFFu : 0xFFFFu);
}

void SystemControl::write(std::uint32_t address, std::uint32_t value, unsigned size) {
  // Registers of byte fields take narrow writes as they are.
  if (address >= 0xE000'E100 && address < 0xE000'E500) return machine_.nvic.write(address - control_space, value, size);
  if (address >= first_handler_priority && address <= last_handler_priority) {
    for (unsigned i = 0; i < size; ++i)
      machine_.nvic.set_priority(4 + (address - first_handler_priority) + i, static_cast<std::uint8_t>(value >> 8 * i));
    return;
  }
  const std::uint32_t word = address & ~3u;
  const bool cleared_by_ones = word == 0xE000'ED28;  // a narrow write must not clear its neighbours
  if (size != 4 && word >= trace_cell_base) value = merge(cleared_by_ones ? 0 : read_word(word), value, address, size);
  write_word(word, value);
}

void SystemControl::write_word(std::uint32_t address, std::uint32_t value) {
  if (address < stimulus_end) return;  // ITM: nobody listens
  if (address <= trace_cell_base + 4 && (debug_monitor_ & trace_enable) == 0) return;
  switch (address) {
    case trace_cell_base:
      cycle_held_ = cycle_count();
      trace_control_ = (trace_control_ & ~0xFFu) | (value & 0xFF);
      cycle_base_ =
          static_cast<std::uint32_t>(machine_.processor->cycles() + machine_.processor->slept_cycles()) - cycle_held_;
      return;
    case trace_cell_base + 4:
      cycle_held_ = value;
      cycle_base_ =
          static_cast<std::uint32_t>(machine_.processor->cycles() + machine_.processor->slept_cycles()) - value;
      return;
    case 0xE000'1FB0: return;  // DWT_LAR: not locked
    case 0xE000'E008: auxiliary_control_ = value; return;
    case 0xE000'ED04: write_interrupt_control_state(value); return;
    case 0xE000'ED08: vector_table_ = value & 0xFFFF'FF80; return;
    case 0xE000'ED0C: write_reset_control(value); return;
    case 0xE000'ED10: sleep_control_ = value & 0x16; return;
    case 0xE000'ED14:
      configuration_ = value & 0x31B;
      if ((value & 0x18) != 0)
        machine_.log.say_once("CCR.UNALIGN_TRP and CCR.DIV_0_TRP are not modelled: no such fault will come");
      return;
    case 0xE000'ED24: write_handler_control_state(value); return;
    case 0xE000'ED28: configurable_faults_ &= ~value; return;
    case 0xE000'ED2C: hard_faults_ &= ~value; return;
    case 0xE000'ED30: debug_faults_ &= ~value; return;
    case 0xE000'ED34: memory_fault_address_ = value; return;
    case 0xE000'ED38: bus_fault_address_ = value; return;
    case 0xE000'ED3C: auxiliary_faults_ = value; return;
    case 0xE000'ED88: coprocessor_access_ = value & 0x00F0'0000; return;
    case 0xE000'EDF0: return;
    case 0xE000'EDFC: debug_monitor_ = value & (trace_enable | 0xF'07F1); return;
    case 0xE000'EF00: machine_.nvic.pend(exception_interrupt_0 + (value & 0x1FF) % Nvic::positions); return;
    case 0xE000'EF34: float_control_ = value & 0xC000'0000; return;
    case 0xE000'EF38: float_address_ = value; return;
    case 0xE000'EF3C: float_default_ = value; return;
    case 0xE004'2004: machine_.sleep_counts_cycles = (value & 1) != 0; return;
    case 0xE004'2008:
    case 0xE004'200C: debug_freeze_[(address - 0xE004'2008) / 4] = value; return;
    default: break;
  }
  if (address >= 0xE000'E010 && address <= 0xE000'E01C) return systick_.write(address - 0xE000'E010, value);
  machine_.log.note("private peripheral bus 0xE0000000", address & 0xFFFFF, true, value);
}

}  // namespace inkwell::virtual_board
