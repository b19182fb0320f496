#include "boards/stm32f405/core/system_control.hpp"

#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {
namespace {

/// Size of the ITM stimulus ports.
constexpr std::uint32_t stimulus_bytes = 0x400;

constexpr std::uint32_t first_handler_priority = scb_base + scb.shpr,
                        end_of_handler_priorities = first_handler_priority + 12;

struct HandlerBit {
  Field field;
  unsigned exception;
};
constexpr HandlerBit active_bits[] = {
    {scb.shcsr.memfaultact, exception_memory_fault}, {scb.shcsr.busfaultact, exception_bus_fault},
    {scb.shcsr.usgfaultact, exception_usage_fault},  {scb.shcsr.svcallact, exception_svcall},
    {scb.shcsr.monitoract, exception_debug},         {scb.shcsr.pendsvact, exception_pendsv},
    {scb.shcsr.systickact, exception_systick}};
constexpr HandlerBit pending_bits[] = {{scb.shcsr.usgfaultpended, exception_usage_fault},
                                       {scb.shcsr.memfaultpended, exception_memory_fault},
                                       {scb.shcsr.busfaultpended, exception_bus_fault},
                                       {scb.shcsr.svcallpended, exception_svcall}};
constexpr HandlerBit enable_bits[] = {{scb.shcsr.memfaultena, exception_memory_fault},
                                      {scb.shcsr.busfaultena, exception_bus_fault},
                                      {scb.shcsr.usgfaultena, exception_usage_fault}};

bool is_priority(std::uint32_t address) {
  return address >= first_handler_priority && address < end_of_handler_priorities;
}
bool is_trace(std::uint32_t address) { return address <= dwt_base + dwt.cyccnt; }

}  // namespace

SystemControl::SystemControl(Machine& machine, Processor& processor)
    : machine_(machine), processor_(processor), systick_(machine) {}

std::vector<RegisterMap> SystemControl::register_maps() {
  return {{"DWT", dwt_base, shown<dwt>()},
          {"SCS", scs_base, shown<scs>()},
          {"STK", stk_base, shown<stk>()},
          {"NVIC", nvic_base, shown<nvic_registers>()},
          {"SCB", scb_base, shown<scb>()},
          {"MPU", mpu_base, shown<mpu>()},
          {"FPU_CPACR", fpu_cpacr_base, shown<fpu_cpacr>()},
          {"CORE_DEBUG", core_debug_base, shown<core_debug>()},
          {"NVIC_STIR", nvic_stir_base, shown<nvic_stir>()},
          {"FPU", fpu_base, shown<fpu>()},
          {"DBG", dbg_base, shown<dbg>()}};
}

void SystemControl::reset() {
  vector_table_ = sleep_control_ = reset_control_ = 0;
  configuration_ = scb.ccr.reset_value;
  machine_.traps_zero_division = false;
  machine_.memory_protection.reset();
  processor_.rights_changed();
  processor_.trap_misaligned(false);
  configurable_faults_ = hard_faults_ = debug_faults_ = 0;
  memory_fault_address_ = bus_fault_address_ = auxiliary_faults_ = 0;
  coprocessor_access_ = auxiliary_control_ = 0;
  float_control_ = fpu.fpccr.reset_value;
  float_address_ = float_default_ = 0;
  debug_monitor_ = 0;
  trace_control_ = dwt.ctrl.reset_value;
  cycle_base_ = cycle_held_ = 0;
  machine_.debug_halt.set_stops(DebugHalt::apb1, 0);
  machine_.debug_halt.set_stops(DebugHalt::apb2, 0);
  systick_.reset();
}

void SystemControl::record_fault(std::uint32_t configurable_bits, std::uint32_t hard_fault_bits) {
  configurable_faults_ |= configurable_bits;
  hard_faults_ |= hard_fault_bits;
}

void SystemControl::note_float_frame(const FloatFrame& frame) {
  const auto& nvic = machine_.nvic;
  const auto could_pend = [&](unsigned exception, bool enabled) {
    return enabled && frame.priority > nvic.group_priority(exception);
  };
  const auto& control = fpu.fpccr;
  float_address_ = frame.address & writable(fpu.fpcar);
  float_control_ = (float_control_ & (control.lspen.mask() | control.aspen.mask())) |
                   control.user.with(!frame.privileged) | control.thread.with(frame.in_thread) |
                   control.hfrdy.with(could_pend(exception_hard_fault, true)) |
                   control.mmrdy.with(could_pend(exception_memory_fault, nvic.enabled(exception_memory_fault))) |
                   control.bfrdy.with(could_pend(exception_bus_fault, nvic.enabled(exception_bus_fault))) |
                   control.monrdy.with(could_pend(exception_debug, core_debug.demcr.mon_en.in(debug_monitor_)));
}

std::uint32_t SystemControl::cycle_count() const {
  if (!dwt.ctrl.cyccntena.in(trace_control_)) return cycle_held_;
  // The cycle counter stops in sleep unless DBGMCU_CR.DBG_SLEEP keeps the clock on.
  const std::uint64_t cycles = processor_.cycles() + processor_.slept_cycles();
  return static_cast<std::uint32_t>(cycles) - cycle_base_;
}

std::uint32_t SystemControl::interrupt_control_state() const {
  const auto& nvic = machine_.nvic;
  const unsigned urgent = nvic.most_urgent();
  const auto& icsr = scb.icsr;
  std::uint32_t value = icsr.vectactive.with(processor_.current_exception()) | icsr.vectpending.with(urgent);
  if (nvic.active_count() <= 1) value |= icsr.rettobase.mask();
  if (urgent >= exception_interrupt_0) value |= icsr.isrpending.mask();
  if (nvic.pending(exception_systick)) value |= icsr.pendstset.mask();
  if (nvic.pending(exception_pendsv)) value |= icsr.pendsvset.mask();
  if (nvic.pending(exception_nmi)) value |= icsr.nmipendset.mask();
  return value;
}

void SystemControl::write_interrupt_control_state(std::uint32_t value) {
  auto& nvic = machine_.nvic;
  if (scb.icsr.pendstclr.in(value)) nvic.unpend(exception_systick);
  if (scb.icsr.pendstset.in(value)) nvic.pend(exception_systick);
  if (scb.icsr.pendsvclr.in(value)) nvic.unpend(exception_pendsv);
  if (scb.icsr.pendsvset.in(value)) nvic.pend(exception_pendsv);
  if (scb.icsr.nmipendset.in(value)) nvic.pend(exception_nmi);
}

void SystemControl::write_reset_control(std::uint32_t value) {
  constexpr std::uint32_t key = 0x05FA;
  if (scb.aircr.vectkey.of(value) != key) return;
  machine_.nvic.set_priority_group(scb.aircr.prigroup.of(value));
  if (scb.aircr.vectreset.in(value)) machine_.violations.violate(Rule::core_reset);
  if (scb.aircr.sysresetreq.in(value)) machine_.request_reset(ResetCause::software);
}

std::uint32_t SystemControl::handler_control_state() const {
  std::uint32_t value = 0;
  for (const auto& b : active_bits) value |= b.field.with(machine_.nvic.active(b.exception));
  for (const auto& b : pending_bits) value |= b.field.with(machine_.nvic.pending(b.exception));
  for (const auto& b : enable_bits) value |= b.field.with(machine_.nvic.enabled(b.exception));
  return value;
}

void SystemControl::write_handler_control_state(std::uint32_t value) {
  for (const auto& b : active_bits) machine_.nvic.set_active(b.exception, b.field.in(value));
  for (const auto& b : enable_bits) machine_.nvic.enable(b.exception, b.field.in(value));
  for (const auto& b : pending_bits)
    if (b.field.in(value))
      machine_.nvic.pend(b.exception);
    else
      machine_.nvic.unpend(b.exception);
}

std::uint32_t SystemControl::read_word(std::uint32_t address) {
  if (address < dwt_base) return (address & 0xFFF) < stimulus_bytes ? 1 : 0;  // stimulus ports are always ready
  if (is_trace(address) && !core_debug.demcr.trcena.in(debug_monitor_)) return 0;
  switch (address) {
    case dwt_base + dwt.ctrl: return trace_control_;
    case dwt_base + dwt.cyccnt: return cycle_count();
    case scs_base + scs.ictr: return scs.ictr.reset_value;
    case scs_base + scs.actlr: return auxiliary_control_;
    case scb_base + scb.cpuid: return scb.cpuid.reset_value;  // Cortex-M4 r0p1
    case scb_base + scb.icsr: return interrupt_control_state();
    case scb_base + scb.vtor: return vector_table_;
    case scb_base + scb.aircr: return scb.aircr.reset_value | scb.aircr.prigroup.with(machine_.nvic.priority_group());
    case scb_base + scb.scr: return sleep_control_;
    case scb_base + scb.ccr: return configuration_;
    case scb_base + scb.shcsr: return handler_control_state();
    case scb_base + scb.cfsr: return configurable_faults_;
    case scb_base + scb.hfsr: return hard_faults_;
    case scb_base + scb.dfsr: return debug_faults_;
    case scb_base + scb.mmfar: return memory_fault_address_;
    case scb_base + scb.bfar: return bus_fault_address_;
    case scb_base + scb.afsr: return auxiliary_faults_;
    case fpu_cpacr_base + fpu_cpacr.cpacr: return coprocessor_access_;
    case core_debug_base + core_debug.dhcsr: return core_debug.dhcsr.c_debugen.with(machine_.debugging.attached);
    case core_debug_base + core_debug.demcr: return debug_monitor_;
    case fpu_base + fpu.fpccr: return float_control_ | fpu.fpccr.lspact.with(processor_.lazy_stacking_due());
    case fpu_base + fpu.fpcar: return float_address_;
    case fpu_base + fpu.fpdscr: return float_default_;
    case fpu_base + fpu.mvfr0: return fpu.mvfr0.reset_value;
    case fpu_base + fpu.mvfr1: return fpu.mvfr1.reset_value;
    case dbg_base + dbg.idcode: return dbg.idcode.reset_value;
    case dbg_base + dbg.cr: return dbg.cr.dbg_sleep.with(machine_.sleep_counts_cycles);
    case dbg_base + dbg.apb1_fz: return machine_.debug_halt.stops(DebugHalt::apb1);
    case dbg_base + dbg.apb2_fz: return machine_.debug_halt.stops(DebugHalt::apb2);
    default: break;
  }
  if (is_priority(address)) {
    const unsigned first = 4 + (address - first_handler_priority);
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{machine_.nvic.priority(first + i)} << 8 * i;
    return value;
  }
  if (address - stk_base < stk_bytes) return systick_.read(address - stk_base);
  if (address - nvic_base < nvic_bytes) return machine_.nvic.read(address - nvic_base);
  if (address - mpu_base < mpu_bytes) return machine_.memory_protection.read(address - mpu_base);
  machine_.log.note("private peripheral bus 0xE0000000", address & 0xFFFFF, false, 0);
  return 0;
}

std::uint32_t SystemControl::read(std::uint32_t address, unsigned size) {
  const std::uint32_t word = read_word(address & ~3u);
  return size == 4 ? word : word >> 8 * (address & 3) & (size == 1 ? 0xFFu : 0xFFFFu);
}

void SystemControl::write(std::uint32_t address, std::uint32_t value, unsigned size) {
  // Registers with byte fields, such as priorities, accept byte and half-word writes.
  if (address - nvic_base < nvic_bytes) return machine_.nvic.write(address - nvic_base, value, size);
  if (is_priority(address)) {
    for (unsigned i = 0; i < size; ++i)
      machine_.nvic.set_priority(4 + (address - first_handler_priority) + i, static_cast<std::uint8_t>(value >> 8 * i));
    return;
  }
  const std::uint32_t word = address & ~3u;
  const bool cleared_by_ones = word == scb_base + scb.cfsr;  // a narrow write must not clear the other bytes
  if (size != 4 && word >= dwt_base) {
    if (!cleared_by_ones) machine_.violations.violate(Rule::narrow_core_write);
    value = merge(cleared_by_ones ? 0 : read_word(word), value, address, size);
  }
  write_word(word, value);
}

void SystemControl::write_word(std::uint32_t address, std::uint32_t value) {
  if (address < dwt_base) return;  // the instrumentation trace has no receiver
  if (is_trace(address) && !core_debug.demcr.trcena.in(debug_monitor_)) return;
  switch (address) {
    case dwt_base + dwt.ctrl:
      cycle_held_ = cycle_count();
      trace_control_ = dwt.ctrl.reset_value | (value & writable(dwt.ctrl));
      cycle_base_ = static_cast<std::uint32_t>(processor_.cycles() + processor_.slept_cycles()) - cycle_held_;
      return;
    case dwt_base + dwt.cyccnt:
      cycle_held_ = value;
      cycle_base_ = static_cast<std::uint32_t>(processor_.cycles() + processor_.slept_cycles()) - value;
      return;
    case dwt_base + dwt.lar: return;  // the trace is never locked
    case scs_base + scs.actlr: auxiliary_control_ = value; return;
    case scb_base + scb.icsr: write_interrupt_control_state(value); return;
    case scb_base + scb.vtor: vector_table_ = value & writable(scb.vtor); return;
    case scb_base + scb.aircr: write_reset_control(value); return;
    case scb_base + scb.scr: sleep_control_ = value & writable(scb.scr); return;
    case scb_base + scb.ccr:
      configuration_ = value & writable(scb.ccr);
      machine_.traps_zero_division = scb.ccr.div_0_trp.in(value);
      processor_.trap_misaligned(scb.ccr.unalign_trp.in(value));
      return;
    case scb_base + scb.shcsr: write_handler_control_state(value); return;
    case scb_base + scb.cfsr: configurable_faults_ &= ~value; return;
    case scb_base + scb.hfsr: hard_faults_ &= ~value; return;
    case scb_base + scb.dfsr: debug_faults_ &= ~value; return;
    case scb_base + scb.mmfar: memory_fault_address_ = value; return;
    case scb_base + scb.bfar: bus_fault_address_ = value; return;
    case scb_base + scb.afsr: auxiliary_faults_ = value; return;
    case fpu_cpacr_base + fpu_cpacr.cpacr: {
      coprocessor_access_ = value & writable(fpu_cpacr.cpacr);
      constexpr std::uint32_t none = 0;  // CP10 and CP11 have the same value (PM0214, CPACR)
      processor_.set_float_unit(coprocessor_access_ != none);
      return;
    }
    case core_debug_base + core_debug.dhcsr: return;
    case core_debug_base + core_debug.demcr: debug_monitor_ = value & writable(core_debug.demcr); return;
    case nvic_stir_base + nvic_stir.stir:
      machine_.nvic.pend(exception_interrupt_0 + nvic_stir.stir.intid.of(value) % Nvic::positions);
      return;
    case fpu_base + fpu.fpccr:
      float_control_ = value & writable(fpu.fpccr) & ~fpu.fpccr.lspact.mask();
      if (!fpu.fpccr.lspact.in(value)) processor_.drop_lazy_stacking();
      return;
    case fpu_base + fpu.fpcar: float_address_ = value; return;
    case fpu_base + fpu.fpdscr: float_default_ = value; return;
    case dbg_base + dbg.cr: machine_.sleep_counts_cycles = dbg.cr.dbg_sleep.in(value); return;
    case dbg_base + dbg.apb1_fz: machine_.debug_halt.set_stops(DebugHalt::apb1, value); return;
    case dbg_base + dbg.apb2_fz: machine_.debug_halt.set_stops(DebugHalt::apb2, value); return;
    default: break;
  }
  if (address - stk_base < stk_bytes) return systick_.write(address - stk_base, value);
  if (address - mpu_base < mpu_bytes) {
    if (!MemoryProtection::names_region(address - mpu_base, value)) machine_.violations.violate(Rule::region_number);
    machine_.memory_protection.write(address - mpu_base, value);
    // The region is checked only when its size is written, because firmware writes the base address first.
    if (!MemoryProtection::is_base(address - mpu_base) && !machine_.memory_protection.is_defined())
      machine_.violations.violate(Rule::region_undefined);
    return processor_.rights_changed();
  }
  machine_.log.note("private peripheral bus 0xE0000000", address & 0xFFFFF, true, value);
}

}  // namespace inkwell::virtual_board
