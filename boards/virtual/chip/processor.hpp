// Cortex-M4F: instructions by Unicorn, exception entry and return by us (ARMv7-M Architecture Reference Manual, B1.5).
#pragma once

#include <unicorn/unicorn.h>

#include <array>
#include <chip/chip.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <timing/cycle_counter.hpp>
#include <timing/peripheral_bus.hpp>
#include <vector>

#include "engine_calls.hpp"
#include "machine.hpp"
#include "plain_stores.hpp"

namespace inkwell::virtual_board {

class Bus;
class SystemControl;

/// Why the processor stopped executing.
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
  data_fault,               ///< nothing answers at fault_address()
  misaligned,               ///< fault_address() is not aligned as the instruction needs it
  protected_data,           ///< the memory protection unit does not allow the access to fault_address()
  instruction_fault,        ///< nothing to execute at fault_address()
  debugger,                 ///< a breakpoint, a watch point, the end of a step
  execute_never,            ///< fault_address() is in a region without instructions
  float_context_lost,       ///< an instruction of the FPU asks for lazy stacking, and the stack is not in RAM
  float_context_protected,  ///< likewise, and the memory protection unit refuses it
};

class Processor final : public ClockUser, private EngineCalls {
 public:
  Processor(Machine& machine, Bus& bus);
  ~Processor() override;
  Processor(const Processor&) = delete;
  Processor& operator=(const Processor&) = delete;

  /// Reset: stack pointer and program counter from the vector table at `vector_table`.
  void reset(std::uint32_t vector_table);
  /// Executes for about `cycles` (fast mode: up to the end of a basic block) or until something happens.
  Outcome run(std::uint64_t cycles);
  /// The current slice ends before the next instruction (fast mode: block).
  void end_slice() { stop_cycle_ = 0; }
  /// While something more urgent is pending, ends the slice as soon as the masks let it through.
  void watch_masks(bool watch) { watch_masks_ = watch; }
  /// The masks that were watched have let something through since the last call.
  bool take_masks_opened() { return std::exchange(masks_opened_, false); }
  /// CPACR lets firmware use the FPU. While it does not, each of the FPU's instructions is stopped at.
  void set_float_unit(bool on) {
    float_unit_on_ = on;
    refuses_float_ = !float_unit_on_ || unstacked_float_;
  }
  /// CCM has its clock (RCC_AHB1ENR.CCMDATARAMEN). It takes effect from the next slice on, which begins at once.
  void set_core_coupled_memory(bool on) {
    core_coupled_on_ = on;
    rights_changed();
  }
  /// CCR.UNALIGN_TRP; as above.
  void trap_misaligned(bool on) {
    traps_misaligned_ = on;
    end_slice();
  }
  /// The memory protection unit was set anew; as above.
  void rights_changed() {
    rights_changed_ = true;
    end_slice();
  }
  /// The flash erases or programs, or is done; what wants it meanwhile waits. Reads are asked about as above.
  void set_flash_busy(bool busy) {
    flash_is_busy_ = busy;
    rights_changed();
  }
  /// The next instruction is one that the flash has no time for.
  bool waits_for_flash() const { return flash_is_busy_ && is_in_flash(program_counter_); }
  static constexpr bool is_in_flash(std::uint32_t address) {
    return address < flash_bytes || address - flash_base < flash_bytes;
  }
  /// After instructions in memory changed.
  void forget_code(std::uint32_t address, std::uint32_t bytes);
  /// The same from inside of a slice, in which the engine would fetch from there, and be refused by the memory
  /// protection unit: before the next slice.
  void forget_code_later(std::uint32_t address, std::uint32_t bytes) { to_forget_.push_back({address, bytes}); }

  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t instructions() const { return instructions_; }
  /// The core stands still for `cycles` of HCLK.
  void wait(unsigned cycles) {
    cycles_ += cycles;
    block_start_ += cycles;
    instruction_end_ += cycles;
  }
  /// The core waits for a register on the way to it.
  void wait_for_register(std::uint32_t address, bool write);
  FlashAccelerator& flash() { return timing_.flash(); }
  void add_sleep_cycles(std::uint64_t cycles) { slept_cycles_ += cycles; }
  std::uint64_t slept_cycles() const { return slept_cycles_; }
  /// Board time of the current instruction (fast mode: of the end of the current block).
  Ticks now() const { return anchor_time_ + machine_.clocks.hclk.duration(cycles_ - anchor_cycles_); }
  /// Cycles that fit until `when`, at least 1.
  std::uint64_t cycles_until(Ticks when) const;
  /// Board time goes on from `time` (after sleep, or a change of clock).
  void anchor(Ticks time) {
    anchor_time_ = time;
    anchor_cycles_ = cycles_;
  }

  // The cycles so far have lasted as long as they did; what is left of the slice is counted anew.
  void before_clock_change() override { anchor(now()); }
  void after_clock_change() override;

  std::uint32_t read(int id) const {
    std::uint32_t value = 0;
    uc_reg_read(engine_, id, &value);
    return value;
  }
  CoreRegisters core_registers() const;
  /// All but the program counter and the exception of xPSR.
  void set_core_registers(const CoreRegisters& registers);
  FloatRegisters read_float_registers() const;
  void write_float_registers(const FloatRegisters& registers);
  /// Stops behind the instruction that touches the place.
  uc_hook watch(const WatchPoint& watch_point);
  void unwatch(uc_hook hook);
  void write(int id, std::uint32_t value) {
    if (!machine_.memory_protection.is_on(false)) {
      uc_reg_write(engine_, id, &value);
    } else {
      const Use use(*this);  // the engine asks what has changed with it: see runs_above_faults()
      uc_reg_write(engine_, id, &value);
    }
  }
  std::uint32_t program_counter() const { return program_counter_; }
  void set_program_counter(std::uint32_t value) { program_counter_ = value; }
  Masks masks() const;
  /// Of the current instruction (fast mode: of the current block).
  std::uint32_t code_address() const { return last_code_address_; }
  unsigned current_exception() const { return current_exception_; }
  std::uint32_t fault_address() const { return fault_address_; }
  bool take_event_register() { return std::exchange(event_register_, false); }
  void set_event_register() { event_register_ = true; }

  // exceptions.cpp
  enum class Entry : std::uint8_t {
    started,
    no_stack,         ///< the stack is not in RAM; the stack pointer has moved all the same
    protected_stack,  ///< the memory protection unit refuses it; likewise
    no_handler,
  };
  /// Stacks the context, unless `stacks` is false, and starts the handler.
  Entry enter_exception(unsigned exception, bool align_stack, bool float_context, bool lazily,
                        std::uint32_t vector_table, bool stacks);
  enum class Return : std::uint8_t {
    done,
    invalid,          ///< what it returns to is not valid
    no_stack,         ///< the frame is not in RAM; the handler that ran has ended all the same
    protected_stack,  ///< the memory protection unit refuses it; likewise
  };
  /// Ends the handler that runs.
  Return return_from_exception(std::uint32_t vector_table);
  /// Starts a handler on the frame of one that has just ended. False: it is not valid.
  bool chain_exception(unsigned exception, std::uint32_t vector_table);
  bool is_in_thread() const { return current_exception_ == exception_none; }
  /// Of the exception that was entered last, if it left room for floats.
  std::optional<FloatFrame> take_float_frame() { return std::exchange(float_frame_, std::nullopt); }
  // float_guards.cpp
  /// FPCCR.LSPACT.
  bool lazy_stacking_due() const;
  /// What the frame has room for is never written.
  void drop_lazy_stacking();
  Counters& counters() { return counters_; }
  /// Called when another exception begins to run, or the thread again (0); none by default.
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
  /// The instruction at `address` divides by zero, outside of if-then blocks.
  bool divides_by_zero(std::uint32_t address) const;
  /// Fast mode: whether the block has divides that are not asked about yet; they are after the slice.
  bool has_new_divides(const BlockPrice& block);
  void ask_about_new_divides();
  static void divide_hook(uc_engine*, std::uint64_t address, std::uint32_t size, void* self);
  bool masks_open();
  /// Unicorn loses the conditions of an if-then block in which it is stopped.
  bool in_if_then_block(std::uint32_t address) const;
  bool in_resumed_if_then_block(std::uint32_t address) const { return address - resumed_at_ < resumed_bytes_; }
  /// A return into the middle of an if-then block, as the fault of one of its instructions makes it.
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
  bool takes_plain_stores(std::uint32_t page) const override { return plain_stores_.plain(page); }
  bool is_device(std::uint32_t address, Role role) const override;
  void misaligned(std::uint32_t address) override;
  bool must_be_aligned(std::uint16_t first, std::uint16_t second) const override;
  void translates(std::uint32_t address) override { timing_.read_anew(address); }
  /// Of what runs now.
  Role role() const;
  std::optional<Outcome> refusal_of(std::uint32_t address, Access access, Role role) const;
  /// No part of a frame there is refused.
  bool takes_any_frame(std::uint32_t address, std::uint32_t bytes) const;
  /// Why a frame's words can not be written or read.
  std::optional<Outcome> refusal_of_stack(std::uint32_t address, unsigned words, Access access, Role as) const;
  /// Of an unprivileged thread, for what it may not write itself.
  void lift_privilege();
  /// S0 to S15 and FPSCR, as a frame has them.
  void read_float_context(std::uint32_t* words) const;
  /// Does the lazy stacking that is due, or says why not.
  std::optional<Outcome> stack_float_context();
  void take_new_rights();
  /// Exact mode: no instruction of the block waits, and nobody wants to know of it.
  bool is_plain(const BlockPrice& block) const;
  bool may_run(std::uint32_t address);
  void wait_in_block(std::uint32_t address, std::uint16_t after_cycles);
  /// Of a block that runs for the first time, or after a change there.
  const BlockPrice& price_block(std::uint32_t address, std::uint32_t bytes);
  /// R0 to R14 by number.
  auto register_reader() const {
    return [this](std::uint8_t number) {
      return read(number <= 12 ? UC_ARM_REG_R0 + number : number == 13 ? UC_ARM_REG_SP : UC_ARM_REG_LR);
    };
  }
  /// Of a divide with the operands that the registers hold now, beyond its shortest.
  unsigned divide_wait(const BlockPrice::Divide& divide) const;
  void map_memories(Bus& bus);
  void map_holes();
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
  uc_engine* engine_ = nullptr;
  std::uint64_t cycles_ = 0, instructions_ = 0, stop_cycle_ = 0, slept_cycles_ = 0;
  Ticks anchor_time_ = 0;
  std::uint64_t anchor_cycles_ = 0;
  std::uint32_t program_counter_ = 0;
  unsigned current_exception_ = 0;
  std::uint32_t last_code_address_ = 0;
  std::array<std::uint32_t, 4> recent_addresses_{};  ///< of the newest instructions; an if-then block holds up to four
  std::uint32_t fault_address_ = 0;
  Outcome outcome_ = Outcome::slice_over;
  std::optional<std::uint32_t> stopped_before_;  ///< this block
  bool stopped_ = false, watch_masks_ = false, masks_opened_ = false, event_register_ = false;
  CycleCounter timing_;
  PeripheralBus register_bus_;
  // Exact mode: the block that runs, when it began, and when its current instruction ends.
  const BlockPrice* block_ = nullptr;
  std::uint64_t block_start_ = 0, instruction_end_ = 0;
  std::size_t next_request_ = 0, next_divide_ = 0, next_read_ = 0;  ///< of the block's
  bool block_is_plain_ = false;
  PlainStores plain_stores_;
  /// Unicorn makes stores into the flash by itself; what the flash made of them is put right after the slice.
  struct FlashStore {
    std::uint32_t address, content;
    unsigned size;
  };
  std::vector<FlashStore> flash_stores_;
  struct CodeRange {
    std::uint32_t address, bytes;
  };
  std::vector<CodeRange> to_forget_;
  std::set<std::uint32_t> divides_asked_about_;
  std::vector<std::uint32_t> new_divides_;
  bool float_unit_on_ = false, core_coupled_on_ = true, rights_changed_ = false;
  bool flash_is_busy_ = false;
  /// Lazy stacking is due that could not be done at entry.
  struct UnstackedFloat {
    std::uint32_t address;  ///< FPCAR
    Role role;              ///< of what was interrupted
  };
  std::optional<UnstackedFloat> unstacked_float_;
  std::optional<FloatFrame> float_frame_;
  void set_unstacked_float(std::optional<UnstackedFloat> what) {
    unstacked_float_ = what;
    refuses_float_ = !float_unit_on_ || unstacked_float_;
  }
  bool refuses_float_ = true;  ///< an instruction of the FPU would fault now; every block asks
  bool traps_misaligned_ = false, translates_aligned_ = false;
  std::optional<Outcome> refusal_;                     ///< of the access that faults
  std::uint32_t resumed_at_ = 0, resumed_bytes_ = 0;   ///< rest of an if-then block that a return went on with
  std::set<std::uint32_t> float_guards_;               ///< instructions of the FPU that are stopped at while it is off
  std::uint32_t guard_address_ = 0, guard_bytes_ = 0;  ///< a block with such instructions to be guarded; 0 bytes: none
  std::vector<Running> running_;
  std::uint64_t counted_until_ = 0;  ///< cycles
  Counters counters_;
};

}  // namespace inkwell::virtual_board
