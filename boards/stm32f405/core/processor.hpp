// Cortex-M4F. Unicorn executes the instructions. The Processor class implements exception entry and return (ARMv7-M
// Architecture Reference Manual, B1.5).
#pragma once

#include <unicorn/unicorn.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "boards/stm32f405/core/bus_windows.hpp"
#include "boards/stm32f405/core/engine_calls.hpp"
#include "boards/stm32f405/core/flash_port.hpp"
#include "boards/stm32f405/core/machine.hpp"
#include "boards/stm32f405/core/plain_stores.hpp"
#include "boards/stm32f405/timing/cycle_counter.hpp"
#include "boards/stm32f405/timing/peripheral_bus.hpp"

namespace inkwell::virtual_board {

/// Reason why the processor stopped.
enum class Outcome : std::uint8_t {
  slice_over,
  wait_for_interrupt,
  wait_for_event,
  supervisor_call,
  breakpoint,
  exception_return,
  undefined_instruction,
  invalid_state,  ///< a branch out of Thumb state
  no_coprocessor,
  division_by_zero,
  data_fault,               ///< no device at fault_address()
  misaligned,               ///< fault_address() does not have the alignment that the instruction needs
  protected_data,           ///< the memory protection unit refuses the access to fault_address()
  instruction_fault,        ///< no code at fault_address()
  debugger,                 ///< a breakpoint, a watch point or the end of a step
  execute_never,            ///< fault_address() is in a region where execution is not allowed
  float_context_lost,       ///< lazy stacking failed at an FPU instruction because the stack is not in RAM
  float_context_protected,  ///< lazy stacking failed because the memory protection unit refused it
};

class Processor final : public ClockUser, private EngineCalls {
 public:
  Processor(Machine& machine, const BusWindows& windows, FlashPort& flash);
  ~Processor() override;
  Processor(const Processor&) = delete;
  Processor& operator=(const Processor&) = delete;

  /// Loads stack pointer and program counter from the vector table.
  void reset(std::uint32_t vector_table);
  /// Runs for about `cycles` cycles or until an event stops the processor. In fast mode, a run stops at the end of a
  /// basic block.
  Outcome run(std::uint64_t cycles);
  /// Ends the current slice before the next instruction (fast mode: before the next block).
  void end_slice() { stop_cycle_ = 0; }
  /// If `watch` is true, the slice ends as soon as the masks allow the most urgent pending exception.
  void watch_masks(bool watch) { watch_masks_ = watch; }
  /// Returns true if the masks have allowed an exception since the last call of this function.
  bool take_masks_opened() { return std::exchange(masks_opened_, false); }
  /// Sets whether CPACR enables the FPU. While the FPU is off, FPU instructions stop the processor.
  void set_float_unit(bool on) {
    float_unit_on_ = on;
    refuses_float_ = !float_unit_on_ || unstacked_float_;
  }
  /// Switches the CCM clock (RCC_AHB1ENR.CCMDATARAMEN). The change ends the slice and takes effect in the next slice.
  void set_core_coupled_memory(bool on) {
    core_coupled_on_ = on;
    rights_changed();
  }
  /// Sets CCR.UNALIGN_TRP. The change takes effect in the next slice.
  void trap_misaligned(bool on) {
    traps_misaligned_ = on;
    end_slice();
  }
  /// Call this function after a change of the MPU settings. The change takes effect in the next slice.
  void rights_changed() {
    rights_changed_ = true;
    end_slice();
  }
  /// Sets whether the flash is erasing or programming. Accesses to a busy flash wait.
  void set_flash_busy(bool busy) {
    flash_is_busy_ = busy;
    rights_changed();
  }
  /// Returns true if the next instruction is in the busy flash.
  bool waits_for_flash() const { return flash_is_busy_ && machine_.memory.is_in_flash(program_counter_); }
  /// Maps another memory at address 0. The change takes effect in the next slice.
  void map_at_zero(MemoryAtZero memory) {
    new_memory_at_zero_ = memory;
    end_slice();
  }
  /// Call this function after a change of instructions in memory.
  void forget_code(std::uint32_t address, std::uint32_t bytes);
  /// Schedules forget_code() for the start of the next slice. During a slice, forget_code() would make the engine fetch
  /// from the range. The memory protection unit might refuse this fetch.
  void forget_code_later(std::uint32_t address, std::uint32_t bytes) { to_forget_.push_back({address, bytes}); }

  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t instructions() const { return instructions_; }
  /// Stops the core for `cycles` HCLK cycles.
  void wait(unsigned cycles) {
    cycles_ += cycles;
    block_start_ += cycles;
    instruction_end_ += cycles;
  }
  /// Adds the bus wait time of a register access.
  void wait_for_register(std::uint32_t address, bool write);
  FlashAccelerator& flash() { return timing_.flash(); }
  void add_sleep_cycles(std::uint64_t cycles) { slept_cycles_ += cycles; }
  std::uint64_t slept_cycles() const { return slept_cycles_; }
  /// Board time of the current instruction (fast mode: end of the current block).
  Ticks now() const { return anchor_time_ + machine_.clocks.hclk.duration(cycles_ - anchor_cycles_); }
  /// Number of HCLK cycles until `when`, at least 1.
  std::uint64_t cycles_until(Ticks when) const;
  /// Sets the board time of the present cycle to `time`. Called after sleep or a clock change.
  void anchor(Ticks time) {
    anchor_time_ = time;
    anchor_cycles_ = cycles_;
  }

  // Cycles before a clock change have the old duration. The rest of the slice is recalculated with the new clock.
  void before_clock_change() override { anchor(now()); }
  void after_clock_change() override;

  std::uint32_t read(int id) const {
    std::uint32_t value = 0;
    uc_reg_read(engine_, id, &value);
    return value;
  }
  CoreRegisters core_registers() const;
  /// Sets all core registers except the program counter and the exception number in xPSR.
  void set_core_registers(const CoreRegisters& registers);
  FloatRegisters read_float_registers() const;
  void write_float_registers(const FloatRegisters& registers);
  /// Adds a watch point. The processor stops after the instruction that accesses the watch point.
  uc_hook watch(const WatchPoint& watch_point);
  void unwatch(uc_hook hook);
  void write(int id, std::uint32_t value) {
    if (!machine_.memory_protection.is_on(false)) {
      uc_reg_write(engine_, id, &value);
    } else {
      const Use use(*this);  // the engine calls runs_above_faults()
      uc_reg_write(engine_, id, &value);
    }
  }
  std::uint32_t program_counter() const { return program_counter_; }
  void set_program_counter(std::uint32_t value) { program_counter_ = value; }
  Masks masks() const;
  /// Address of the current instruction (fast mode: of the current block).
  std::uint32_t code_address() const { return last_code_address_; }
  unsigned current_exception() const { return current_exception_; }
  std::uint32_t fault_address() const { return fault_address_; }
  bool take_event_register() { return std::exchange(event_register_, false); }
  void set_event_register() { event_register_ = true; }

  // exceptions.cpp
  enum class Entry : std::uint8_t {
    started,
    no_stack,         ///< the stack is not in RAM; the stack pointer has still moved
    protected_stack,  ///< the memory protection unit refuses the stack; the stack pointer has still moved
    no_handler,
  };
  /// Starts the handler. If `stacks` is true, the function first stacks the context.
  Entry enter_exception(unsigned exception, bool align_stack, bool float_context, bool lazily,
                        std::uint32_t vector_table, bool stacks);
  enum class Return : std::uint8_t {
    done,
    invalid,          ///< invalid return state
    no_stack,         ///< the frame is not in RAM; the handler is no longer active
    protected_stack,  ///< the memory protection unit refuses the frame; the handler is no longer active
  };
  Return return_from_exception(std::uint32_t vector_table);
  /// Starts a handler with the stack frame of the previous handler (tail-chaining). Returns false if the vector of the
  /// new handler is invalid.
  bool chain_exception(unsigned exception, std::uint32_t vector_table);
  bool is_in_thread() const { return current_exception_ == exception_none; }
  /// Returns and clears the float frame of the most recent exception entry.
  std::optional<FloatFrame> take_float_frame() { return std::exchange(float_frame_, std::nullopt); }
  // float_guards.cpp
  /// FPCCR.LSPACT.
  bool lazy_stacking_due() const;
  /// Discards the pending lazy stacking. The reserved stack space is not written.
  void drop_lazy_stacking();
  Counters& counters() { return counters_; }
  /// The processor calls this function with the exception number when a handler starts or resumes. The number is 0 when
  /// thread mode resumes.
  std::function<void(unsigned exception)> on_exception;
  void clear_counters();

 private:
  struct Running {
    unsigned exception;
    std::uint64_t own_cycles;
  };
  static void block_hook(uc_engine*, std::uint64_t address, std::uint32_t size, void* self);
  static void code_hook(uc_engine*, std::uint64_t address, std::uint32_t size, void* self);
  static void interrupt_hook(uc_engine*, std::uint32_t number, void* self);
  static bool flash_store_hook(uc_engine*, uc_mem_type type, std::uint64_t address, int size, std::int64_t value,
                               void* self);
  static bool invalid_hook(uc_engine*, void* self);
  static void watch_hook(uc_engine*, uc_mem_type type, std::uint64_t address, int size, std::int64_t value, void* self);
  bool stop_for_debugger(std::uint32_t address);
  // division.cpp

  /// Returns true if the instruction at `address` divides by zero outside of if-then blocks.
  bool divides_by_zero(std::uint32_t address) const;
  /// In fast mode, returns true if a divide instruction of the block has no hook. The hooks are added after the slice.
  bool has_new_divides(const BlockPrice& block);
  void hook_new_divides();
  static void divide_hook(uc_engine*, std::uint64_t address, std::uint32_t size, void* self);
  bool masks_open();
  /// If Unicorn stops inside an if-then block, the if-then state is lost.
  bool in_if_then_block(std::uint32_t address) const;
  bool in_resumed_if_then_block(std::uint32_t address) const { return address - resumed_at_ < resumed_bytes_; }
  /// Handles an exception return into the middle of an if-then block, for example after a fault in the block.
  void resume_if_then_block(std::uint32_t status);
  bool if_then_block_covers(std::uint32_t if_then, std::uint32_t address) const;
  void finish_flash_stores();
  // float_guards.cpp
  bool has_unguarded_float(std::uint32_t address, std::uint32_t bytes);
  void guard_float_instructions();
  static void float_hook(uc_engine*, std::uint64_t address, std::uint32_t size, void* self);
  // access.cpp
  bool refuses(std::uint32_t address, unsigned bytes, Access access, Role role) override;
  int rights_in_page(std::uint32_t page, std::uint32_t bytes, Role role) override;
  bool may_fetch(std::uint32_t address) const override { return !refusal_of(address, Access::fetch, role()); }
  bool runs_above_faults() const override;
  bool takes_plain_stores(std::uint32_t page) const override {
    const bool is_at_zero = page < sram1_bytes;
    return (!is_at_zero || machine_.memory.at_zero() == MemoryAtZero::sram1) && plain_stores_.plain(page);
  }
  bool is_device(std::uint32_t address, Role role) const override;
  void misaligned(std::uint32_t address) override;
  bool must_be_aligned(std::uint16_t first, std::uint16_t second) const override;
  void translates(std::uint32_t address) override { timing_.reread(address); }
  Role role() const;
  std::optional<Outcome> refusal_of(std::uint32_t address, Access access, Role role) const;
  /// Returns true if all accesses to the frame are allowed.
  bool takes_any_frame(std::uint32_t address, std::uint32_t bytes) const;
  /// Returns the reason why a word of a frame cannot be accessed, or nothing.
  std::optional<Outcome> refusal_of_stack(std::uint32_t address, unsigned words, Access access, Role as) const;
  /// Makes an unprivileged thread privileged. The model can then write protected registers.
  void lift_privilege();
  /// Reads S0 to S15 and FPSCR in the order of the frame.
  void read_float_context(std::uint32_t* words) const;
  /// Performs the pending lazy stacking. Returns the reason of a refused access, or nothing.
  std::optional<Outcome> stack_float_context();
  void take_new_rights();
  /// In exact mode, returns true if the block needs no check at each instruction.
  bool is_plain(const BlockPrice& block) const;
  bool may_run(std::uint32_t address);
  void wait_in_block(std::uint32_t address, std::uint16_t after_cycles);
  /// Computes the price of a block before its first run and after a change of its code.
  const BlockPrice& price_block(std::uint32_t address, std::uint32_t bytes);
  /// Returns a function that reads R0 to R14 by number.
  auto register_reader() const {
    return [this](std::uint8_t number) {
      return read(number <= 12 ? UC_ARM_REG_R0 + number : number == 13 ? UC_ARM_REG_SP : UC_ARM_REG_LR);
    };
  }
  /// Returns the additional cycles of a divide instruction compared with the shortest divide.
  unsigned divide_wait(const BlockPrice::Divide& divide) const;
  void map_memories();
  void map_memory_at_zero();
  void take_new_memory_at_zero();
  void map_holes();
  void map_hole(std::uint64_t first, std::uint64_t end);
  void stop() {
    stopped_ = true;
    uc_emu_stop(engine_);
  }
  void stop_before(std::uint32_t block) {
    stopped_before_ = block;
    stop();
  }
  void begin_counting(unsigned exception);
  void end_counting();
  bool start_handler(unsigned exception, std::uint32_t exception_return, std::uint32_t vector_table);

  Machine& machine_;
  const BusWindows windows_;
  FlashPort& flash_port_;
  uc_engine* engine_ = nullptr;
  std::uint64_t cycles_ = 0, instructions_ = 0, stop_cycle_ = 0, slept_cycles_ = 0;
  Ticks anchor_time_ = 0;
  std::uint64_t anchor_cycles_ = 0;
  std::uint32_t program_counter_ = 0;
  unsigned current_exception_ = 0;
  std::uint32_t last_code_address_ = 0;
  std::array<std::uint32_t, 4> recent_addresses_{};  ///< last instructions; an if-then block has up to four
  std::uint32_t fault_address_ = 0;
  Outcome outcome_ = Outcome::slice_over;
  std::optional<std::uint32_t> stopped_before_;  ///< block before which the processor stopped
  bool stopped_ = false, watch_masks_ = false, masks_opened_ = false, event_register_ = false;
  CycleCounter timing_;
  PeripheralBus register_bus_;
  // These variables describe the current block in exact mode.
  const BlockPrice* block_ = nullptr;
  std::uint64_t block_start_ = 0, instruction_end_ = 0;
  std::size_t next_request_ = 0, next_divide_ = 0, next_read_ = 0;  ///< within the block
  bool block_is_plain_ = false;
  PlainStores plain_stores_;
  std::optional<MemoryAtZero> new_memory_at_zero_;
  /// Unicorn writes each store directly to the flash memory. After the slice, the contents are replaced by the
  /// programmed values.
  struct FlashStore {
    std::uint32_t address, content;
    unsigned size;
  };
  std::vector<FlashStore> flash_stores_;
  struct CodeRange {
    std::uint32_t address, bytes;
  };
  std::vector<CodeRange> to_forget_;
  std::set<std::uint32_t> hooked_divides_;
  std::vector<std::uint32_t> new_divides_;
  bool float_unit_on_ = false, core_coupled_on_ = true, rights_changed_ = false;
  bool flash_is_busy_ = false;
  /// Lazy stacking that failed at exception entry.
  struct UnstackedFloat {
    std::uint32_t address;  ///< FPCAR
    Role role;              ///< of the interrupted code
  };
  std::optional<UnstackedFloat> unstacked_float_;
  std::optional<FloatFrame> float_frame_;
  void set_unstacked_float(std::optional<UnstackedFloat> what) {
    unstacked_float_ = what;
    refuses_float_ = !float_unit_on_ || unstacked_float_;
  }
  bool refuses_float_ = true;  ///< FPU instructions would fault now; checked at every block
  bool traps_misaligned_ = false, translates_aligned_ = false;
  std::optional<Outcome> refusal_;                     ///< of the faulting access
  std::uint32_t resumed_at_ = 0, resumed_bytes_ = 0;   ///< rest of an if-then block after an exception return
  std::set<std::uint32_t> float_guards_;               ///< FPU instructions that have a hook
  std::uint32_t guard_address_ = 0, guard_bytes_ = 0;  ///< block whose FPU instructions need hooks; 0 bytes: none
  std::vector<Running> running_;
  std::uint64_t counted_until_ = 0;  ///< cycles
  Counters counters_;
};

}  // namespace inkwell::virtual_board
