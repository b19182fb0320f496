// Exception entry, exception return, and cycle counts of handlers.
#include <algorithm>
#include <bit>
#include <cstring>

#include "boards/stm32f405/core/processor.hpp"
#include "boards/stm32f405/core/xpsr.hpp"

namespace inkwell::virtual_board {
namespace {

// The extended frame contains the basic frame, then S0 to S15, FPSCR and an unused word.
constexpr std::uint32_t basic_frame_bytes = 0x20, extended_frame_bytes = 0x68;
constexpr unsigned basic_words = 8, float_words = 17;
constexpr std::uint32_t control_unprivileged = 1, control_spsel = 2, control_fpca = 4;
// Bits of EXC_RETURN (ARMv7-M, table B1-8): basic frame (4), thread mode (3), process stack (2).
constexpr std::uint32_t exc_return_handler = 0xFFFFFFF1, exc_return_basic = 1u << 4, exc_return_thread = 1u << 3,
                        exc_return_process_stack = 1u << 2;

// Registers are accessed in batches, because each engine call is slow.
int frame_registers[] = {UC_ARM_REG_R0, UC_ARM_REG_R1,   UC_ARM_REG_R2, UC_ARM_REG_R3,     UC_ARM_REG_R12,
                         UC_ARM_REG_LR, UC_ARM_REG_XPSR, UC_ARM_REG_SP, UC_ARM_REG_CONTROL};
int float_registers[] = {UC_ARM_REG_D0, UC_ARM_REG_D1, UC_ARM_REG_D2, UC_ARM_REG_D3,
                         UC_ARM_REG_D4, UC_ARM_REG_D5, UC_ARM_REG_D6, UC_ARM_REG_D7};
constexpr int doubles = 8;

}  // namespace

void Processor::begin_counting(unsigned exception) {
  if (!running_.empty()) running_.back().own_cycles += cycles_ - counted_until_;
  counted_until_ = cycles_;
  running_.push_back({exception, 0});
}

void Processor::end_counting() {
  if (running_.empty()) return;
  auto& done = running_.back();
  done.own_cycles += cycles_ - counted_until_;
  counted_until_ = cycles_;
  auto& entry = counters_.exceptions[done.exception];
  ++entry.count;
  entry.longest_cycles = std::max(entry.longest_cycles, done.own_cycles);
  running_.pop_back();
}

void Processor::clear_counters() { counters_ = {}; }

bool Processor::start_handler(unsigned exception, std::uint32_t exception_return, std::uint32_t vector_table) {
  const std::uint32_t vector = machine_.memory.word(vector_table + 4 * exception);
  current_exception_ = exception;  // set before the engine calls runs_above_faults()
  write(UC_ARM_REG_LR, exception_return);
  write(UC_ARM_REG_IPSR, exception);
  write(UC_ARM_REG_EPSR, xpsr.thumb.mask());  // no if-then block is active
  resumed_bytes_ = 0;
  write(UC_ARM_REG_APSR_NZCV, 0);  // makes Unicorn update the mode; the flags are undefined at entry
  program_counter_ = vector;
  timing_.redirect();
  machine_.nvic.enter(exception);
  begin_counting(exception);
  if (on_exception) on_exception(exception);
  return (vector & 1) != 0;
}

Processor::Entry Processor::enter_exception(unsigned exception, bool align_stack, bool float_context, bool lazily,
                                            std::uint32_t vector_table, bool stacks) {
  std::uint32_t values[9];
  void* pointers[9];
  for (int i = 0; i < 9; ++i) pointers[i] = &values[i];
  uc_reg_read_batch(engine_, frame_registers, pointers, 9);
  // The two lowest bits of stack pointers are always 0 (ARMv7-M, B1.4.1), but MSR can set these bits in Unicorn.
  const std::uint32_t stack_pointer = values[7] & ~3u, control = values[8];
  const bool extended = float_context && (control & control_fpca) != 0;
  const bool aligned = (align_stack || extended) && (stack_pointer & 4) != 0;
  const std::uint32_t bytes = extended ? extended_frame_bytes : basic_frame_bytes;
  const std::uint32_t frame = stacks ? (stack_pointer - bytes) & ~(aligned ? 4u : 0u) : stack_pointer;
  std::optional<Outcome> float_refusal;
  if (stacks && !takes_any_frame(frame, bytes)) {
    auto refusal = refusal_of_stack(frame, basic_words, Access::store, role());
    if (extended) float_refusal = refusal_of_stack(frame + basic_frame_bytes, float_words, Access::store, role());
    if (!lazily && !refusal) refusal = float_refusal;
    if (refusal) {
      write(UC_ARM_REG_SP, frame);
      return refusal == Outcome::protected_data ? Entry::protected_stack : Entry::no_stack;
    }
  }

  const std::uint32_t status = (values[6] & ~(xpsr.padded.mask() | xpsr.exception.mask())) | xpsr.thumb.mask() |
                               xpsr.padded.with(aligned) | current_exception_;
  std::uint32_t words[extended_frame_bytes / 4] = {
      values[0], values[1], values[2], values[3], values[4], values[5], program_counter_ & ~1u, status};
  // FPU registers are stacked immediately, even if FPCCR selects lazy stacking. Only the contents of the stack memory
  // reveal the early stacking to firmware. If an access is refused, the next FPU instruction repeats the stacking.
  if (extended && !float_refusal) read_float_context(&words[basic_words]);
  if (stacks) {
    const std::uint32_t written = 4 * (extended && !float_refusal ? basic_words + float_words : basic_words);
    std::memcpy(machine_.memory.ram_at(frame, written), words, written);
  }
  if (extended) set_unstacked_float({});
  if (extended && lazily)
    float_frame_ = FloatFrame{frame + basic_frame_bytes, machine_.nvic.execution_priority(masks()), role().privileged,
                              current_exception_ == exception_none};
  if (float_refusal) set_unstacked_float(UnstackedFloat{frame + basic_frame_bytes, role()});

  std::uint32_t exception_return = exc_return_handler & ~(extended ? exc_return_basic : 0u);
  if (current_exception_ == exception_none) {
    exception_return |= exc_return_thread;
    if ((control & control_spsel) != 0) exception_return |= exc_return_process_stack;
  }
  write(UC_ARM_REG_SP, frame);
  const bool unprivileged = current_exception_ == exception_none && (control & control_unprivileged) != 0;
  if (unprivileged) lift_privilege();
  // SPSEL must be cleared before the mode changes; otherwise Unicorn mixes up its banked stack pointers.
  if (unprivileged || (control & (control_spsel | control_fpca)) != 0)
    write(UC_ARM_REG_CONTROL, control & ~(control_spsel | control_fpca));
  const bool started = start_handler(exception, exception_return, vector_table);
  const auto& costs = timing_.costs();
  wait(costs[Cost::exception_entry] + costs[Cost::vector_from_flash] * timing_.flash().wait_states());
  if (extended) {
    timing_.stack_lazily(lazily);
    if (!lazily) wait(costs[Cost::lazy_stacking] - 1);
  }
  return started ? Entry::started : Entry::no_handler;
}

void Processor::resume_if_then_block(std::uint32_t status) {
  resumed_bytes_ = 0;
  if ((status & xpsr.if_then()) == 0) return;
  // In the lower half of ITSTATE, the lowest set bit marks the end of the if-then block (ARMv7-M, B1.4.2).
  const std::uint32_t state = xpsr.if_then_state(status);
  resumed_at_ = program_counter_ & ~1u;
  for (int left = 4 - std::countr_zero(state); left > 0; --left)
    resumed_bytes_ += is_wide(machine_.memory.half_word(resumed_at_ + resumed_bytes_)) ? 4 : 2;
}

// This function must be fast, because every exception calls it.
bool Processor::takes_any_frame(std::uint32_t address, std::uint32_t bytes) const {
  return !machine_.memory_protection.is_on(false) && core_coupled_on_ &&
         machine_.memory.ram_at(address, bytes) != nullptr;
}

// Access rights change only at multiples of 32 bytes.
std::optional<Outcome> Processor::refusal_of_stack(std::uint32_t address, unsigned words, Access access,
                                                   Role as) const {
  constexpr std::uint32_t granule_bytes = 32;
  const std::uint32_t bytes = 4 * words;
  for (std::uint32_t done = 0; done < bytes; done += granule_bytes - (address + done) % granule_bytes)
    if (const auto refusal = refusal_of(address + done, access, as)) return refusal;
  if (machine_.memory.ram_at(address, bytes) == nullptr) return Outcome::data_fault;
  return {};
}

// In an unprivileged thread, Unicorn also refuses register writes by the virtual board. In handler mode, Unicorn allows
// writes to CONTROL.
void Processor::lift_privilege() {
  const std::uint32_t control = read(UC_ARM_REG_CONTROL);
  write(UC_ARM_REG_IPSR, exception_hard_fault);
  write(UC_ARM_REG_CONTROL, control & ~control_unprivileged);
  write(UC_ARM_REG_IPSR, exception_none);
}

void Processor::read_float_context(std::uint32_t* words) const {
  void* pointers[doubles];
  for (int i = 0; i < doubles; ++i) pointers[i] = &words[2 * i];
  uc_reg_read_batch(engine_, float_registers, pointers, doubles);
  words[2 * doubles] = read(UC_ARM_REG_FPSCR);
}

std::optional<Outcome> Processor::stack_float_context() {
  const auto refusal = refusal_of_stack(unstacked_float_->address, float_words, Access::store, unstacked_float_->role);
  if (refusal) return refusal;
  std::uint32_t words[float_words];
  read_float_context(words);
  std::memcpy(machine_.memory.ram_at(unstacked_float_->address, sizeof words), words, sizeof words);
  set_unstacked_float({});
  return {};
}

bool Processor::chain_exception(unsigned exception, std::uint32_t vector_table) {
  const std::uint32_t control = read(UC_ARM_REG_CONTROL);
  if ((control & control_fpca) != 0) write(UC_ARM_REG_CONTROL, control & ~control_fpca);
  return start_handler(exception, fault_address_, vector_table);
}

Processor::Return Processor::return_from_exception(std::uint32_t vector_table) {
  const std::uint32_t exception_return = fault_address_;
  const bool to_thread = (exception_return & exc_return_thread) != 0;
  const bool process_stack = (exception_return & exc_return_process_stack) != 0;
  const bool extended = (exception_return & exc_return_basic) == 0;
  const unsigned leaving = current_exception_;
  auto& nvic = machine_.nvic;
  if (!nvic.active(leaving) || (!to_thread && process_stack)) return Return::invalid;

  nvic.leave(leaving);
  if (leaving != exception_nmi) write(UC_ARM_REG_FAULTMASK, 0);
  const unsigned next = nvic.next(masks());
  wait(timing_.costs()[next != exception_none ? Cost::exception_tail_chain : Cost::exception_return]);
  end_counting();

  // The pending exception reuses the existing frame (tail-chaining).
  if (next != exception_none) return chain_exception(next, vector_table) ? Return::done : Return::invalid;

  const std::uint32_t frame = read(process_stack ? UC_ARM_REG_PSP : UC_ARM_REG_MSP) & ~3u;
  const std::uint32_t bytes = extended ? extended_frame_bytes : basic_frame_bytes;
  const bool float_stacked = extended && !unstacked_float_;
  const unsigned words_to_read = float_stacked ? basic_words + float_words : basic_words;
  if (!takes_any_frame(frame, bytes)) {
    // The frame is read with the access rights of the interrupted code (ARMv7-M, B1.5.8).
    const Role as{!to_thread || (read(UC_ARM_REG_CONTROL) & control_unprivileged) == 0,
                  nvic.execution_priority(masks()) < 0};
    if (const auto refusal = refusal_of_stack(frame, words_to_read, Access::load, as))
      return refusal == Outcome::protected_data ? Return::protected_stack : Return::no_stack;
  }
  std::uint32_t words[extended_frame_bytes / 4];
  std::memcpy(words, machine_.memory.ram_at(frame, 4 * words_to_read), 4 * words_to_read);
  const std::uint32_t status = words[7];
  const unsigned exception = xpsr.exception.of(status);
  // The mode in the frame must match the mode in EXC_RETURN.
  if ((exception == exception_none) != to_thread || exception >= exception_numbers) return Return::invalid;

  current_exception_ = exception;  // set before the engine calls runs_above_faults()
  if (extended) set_unstacked_float({});
  if (float_stacked) {
    void* float_pointers[doubles];
    for (int i = 0; i < doubles; ++i) float_pointers[i] = &words[basic_words + 2 * i];
    uc_reg_write_batch(engine_, float_registers, float_pointers, doubles);
    write(UC_ARM_REG_FPSCR, words[24]);
  }
  const std::uint32_t stack_pointer = (frame + bytes) | (xpsr.padded.in(status) ? 4u : 0u);
  const std::uint32_t privilege = read(UC_ARM_REG_CONTROL) & control_unprivileged;
  const std::uint32_t control = (process_stack ? control_spsel : 0u) | (extended ? control_fpca : 0u);
  if (privilege != 0) write(UC_ARM_REG_CONTROL, 0);  // while CONTROL is still writable
  write(UC_ARM_REG_IPSR, exception);
  write(UC_ARM_REG_CONTROL, control);
  write(process_stack ? UC_ARM_REG_PSP : UC_ARM_REG_MSP, stack_pointer);
  if (privilege != 0) write(UC_ARM_REG_CONTROL, control | privilege);
  void* pointers[6];
  for (int i = 0; i < 6; ++i) pointers[i] = &words[i];
  uc_reg_write_batch(engine_, frame_registers, pointers, 6);
  write(UC_ARM_REG_XPSR_NZCVQG, (status & (xpsr.flags() | xpsr.if_then())) | xpsr.thumb.mask() | exception);
  // Unicorn updates its internal copies of the flags when APSR is written, so APSR is written last.
  write(UC_ARM_REG_APSR_NZCV, status & xpsr.conditions.mask());
  program_counter_ = words[6];
  resume_if_then_block(status);
  timing_.redirect();
  if (extended) {
    // An FPU context that was never stacked needs no unstacking.
    if (!timing_.lazy_stacking_due()) wait(timing_.costs()[Cost::float_unstacking]);
    timing_.stack_lazily(false);
  }
  if (on_exception) on_exception(exception);
  return Return::done;
}

}  // namespace inkwell::virtual_board
