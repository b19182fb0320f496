// Private peripheral bus of the Cortex-M4 (ARMv7-M, B3.2, B3.3, C1.6, C1.8). The model consists of the system control
// block, SysTick, the floating-point context registers, the cycle counter and some debug registers.
#pragma once

#include <array>
#include <cstdint>

#include "boards/stm32f405/core/machine.hpp"
#include "boards/stm32f405/core/system_map.hpp"

namespace inkwell::virtual_board {

class SysTick final : public TimedPart, public ClockUser, public Freezable {
 public:
  explicit SysTick(Machine& machine);
  void reset();
  std::uint32_t read(std::uint32_t offset);
  void write(std::uint32_t offset, std::uint32_t value);
  void step(Ticks now) override;
  void before_clock_change() override;
  void after_clock_change() override;
  void freeze(bool frozen) override;

 private:
  std::uint32_t current() const;
  Ticks duration(std::uint64_t counts) const;
  void start(std::uint32_t counts_until_zero);
  void announce();
  Machine& machine_;
  Timeline::Slot slot_;
  std::uint32_t control_ = 0, reload_ = 0, held_ = 0;
  Ticks zero_at_ = never;
  bool frozen_ = false;
};

class Processor;

class SystemControl {
 public:
  SystemControl(Machine& machine, Processor& processor);
  void reset();
  std::uint32_t read(std::uint32_t address, unsigned size);
  void write(std::uint32_t address, std::uint32_t value, unsigned size);
  static std::vector<RegisterMap> register_maps();

  std::uint32_t vector_table() const { return vector_table_; }
  bool aligns_stack() const { return scb.ccr.stkalign.in(configuration_); }
  bool preserves_float_context() const { return fpu.fpccr.aspen.in(float_control_); }
  bool stacks_lazily() const { return fpu.fpccr.lspen.in(float_control_); }
  bool sleeps_on_exit() const { return scb.scr.sleeponexit.in(sleep_control_); }
  bool sends_event_on_pending() const { return scb.scr.sevonpend.in(sleep_control_); }

  /// Records the cause of a fault in CFSR and HFSR. The valid bits in CFSR show whether BFAR or MMFAR contains the
  /// fault address.
  void record_fault(std::uint32_t configurable_bits, std::uint32_t hard_fault_bits);
  void record_bus_fault_address(std::uint32_t address) { bus_fault_address_ = address; }
  /// Stores the state for lazy stacking in FPCCR and FPCAR (ARMv7-M, B1.5.7, UpdateFPCCR).
  void note_float_frame(const FloatFrame& frame);
  void record_memory_fault_address(std::uint32_t address) { memory_fault_address_ = address; }

 private:
  std::uint32_t read_word(std::uint32_t address);
  void write_word(std::uint32_t address, std::uint32_t value);
  std::uint32_t interrupt_control_state() const;
  void write_interrupt_control_state(std::uint32_t value);
  void write_reset_control(std::uint32_t value);
  std::uint32_t handler_control_state() const;
  void write_handler_control_state(std::uint32_t value);
  std::uint32_t cycle_count() const;

  Machine& machine_;
  Processor& processor_;
  SysTick systick_;
  std::uint32_t vector_table_ = 0, sleep_control_ = 0, configuration_ = scb.ccr.reset_value, reset_control_ = 0;
  std::uint32_t configurable_faults_ = 0, hard_faults_ = 0, debug_faults_ = 0;
  std::uint32_t memory_fault_address_ = 0, bus_fault_address_ = 0, auxiliary_faults_ = 0;
  std::uint32_t coprocessor_access_ = 0, auxiliary_control_ = 0;
  std::uint32_t float_control_ = fpu.fpccr.reset_value, float_address_ = 0, float_default_ = 0;
  std::uint32_t debug_monitor_ = 0, trace_control_ = dwt.ctrl.reset_value;
  std::uint32_t cycle_base_ = 0, cycle_held_ = 0;
};

}  // namespace inkwell::virtual_board
