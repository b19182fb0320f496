// Access of a debugger to the processor: registers, breakpoints and watch points.
#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/core/processor.hpp"
#include "boards/stm32f405/core/xpsr.hpp"

namespace inkwell::virtual_board {

CoreRegisters Processor::core_registers() const {
  CoreRegisters registers;
  for (unsigned i = 0; i <= 12; ++i) registers.general[i] = read(UC_ARM_REG_R0 + static_cast<int>(i));
  registers.general[CoreRegisters::sp] = read(UC_ARM_REG_SP);
  registers.general[CoreRegisters::lr] = read(UC_ARM_REG_LR);
  registers.general[CoreRegisters::pc] = program_counter_ & ~1u;
  registers.xpsr = (read(UC_ARM_REG_XPSR) & ~xpsr.exception.mask()) | xpsr.thumb.mask() | current_exception_;
  return registers;
}

void Processor::set_core_registers(const CoreRegisters& registers) {
  for (unsigned i = 0; i <= 12; ++i) write(UC_ARM_REG_R0 + static_cast<int>(i), registers.general[i]);
  write(UC_ARM_REG_SP, registers.general[CoreRegisters::sp] & ~3u);
  write(UC_ARM_REG_LR, registers.general[CoreRegisters::lr]);
  write(UC_ARM_REG_XPSR_NZCVQG, (registers.xpsr & xpsr.flags()) | xpsr.thumb.mask() | current_exception_);
  write(UC_ARM_REG_APSR_NZCV,
        registers.xpsr & xpsr.conditions.mask());  // written last, because this write rebuilds Unicorn's internal
                                                   // copies of the flags
}

FloatRegisters Processor::read_float_registers() const {
  FloatRegisters registers;
  for (unsigned i = 0; i < registers.doubles.size(); ++i)
    uc_reg_read(engine_, UC_ARM_REG_D0 + static_cast<int>(i), &registers.doubles[i]);
  registers.fpscr = read(UC_ARM_REG_FPSCR);
  return registers;
}

void Processor::write_float_registers(const FloatRegisters& registers) {
  for (unsigned i = 0; i < registers.doubles.size(); ++i)
    uc_reg_write(engine_, UC_ARM_REG_D0 + static_cast<int>(i), &registers.doubles[i]);
  write(UC_ARM_REG_FPSCR, registers.fpscr);
}

bool Processor::stop_for_debugger(std::uint32_t address) {
  auto& debugging = machine_.debugging;
  if (!debugging.stops_at(address) || in_if_then_block(address)) {
    debugging.resumed_at.reset();
    return false;
  }
  debugging.note_stop_at(address);
  outcome_ = Outcome::debugger;
  stop();
  return true;
}

uc_hook Processor::watch(const WatchPoint& watch_point) {
  const int types = (watch_point.on_read ? UC_HOOK_MEM_READ : 0) | (watch_point.on_write ? UC_HOOK_MEM_WRITE : 0);
  uc_hook hook = 0;
  const std::uint64_t first = watch_point.address, last = first + watch_point.bytes - 1;
  if (uc_hook_add(engine_, &hook, types, reinterpret_cast<void*>(watch_hook), this, first, last) != UC_ERR_OK)
    throw ChipError("The processor emulation (Unicorn) cannot watch memory.");
  // Code that was translated before this call does not call the hook.
  forget_code(flash_base, flash_bytes);
  forget_code(sram_base, sram_bytes);
  return hook;
}

void Processor::unwatch(uc_hook hook) {
  uc_hook_del(engine_, hook);
  forget_code(flash_base, flash_bytes);
  forget_code(sram_base, sram_bytes);
}

void Processor::watch_hook(uc_engine*, uc_mem_type, std::uint64_t address, int, std::int64_t, void* pointer) {
  static_cast<Processor*>(pointer)->machine_.debugging.touched = static_cast<std::uint32_t>(address);
}

}  // namespace inkwell::virtual_board
