#include "boards/stm32f405/wiring/execution.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "boards/stm32f405/core/semihosting.hpp"
#include "boards/stm32f405/wiring/boot_loader.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint16_t semihosting_breakpoint = 0xBEAB;

std::string name_of(unsigned exception) {
  switch (exception) {
    case exception_nmi: return "NMI";
    case exception_hard_fault: return "HardFault";
    case exception_memory_fault: return "MemManage";
    case exception_bus_fault: return "BusFault";
    case exception_usage_fault: return "UsageFault";
    case exception_svcall: return "SVCall";
    case exception_debug: return "DebugMonitor";
    case exception_pendsv: return "PendSV";
    case exception_systick: return "SysTick";
    default: return "interrupt " + std::to_string(exception - exception_interrupt_0);
  }
}

std::string at(const char* what, std::uint32_t address, std::uint32_t program_counter) {
  char text[96];
  std::snprintf(text, sizeof text, "%s 0x%08X, program counter 0x%08X", what, static_cast<unsigned>(address),
                static_cast<unsigned>(program_counter));
  return text;
}

}  // namespace

void Execution::reset(ResetCause cause) {
  machine_.reset_requested = false;
  machine_.nvic.reset();
  bus_.reset_peripherals();
  rcc_.record_reset(cause);
  system_control_.reset();
  machine_.sleep_counts_cycles = false;
  processor_.reset(system_control_.vector_table());
  processor_.anchor(machine_.timeline.now());
  machine_.core_stalls_until = machine_.supply_is_low ? never : 0;
  machine_.thread_stalls_until = 0;
  machine_.debug_halt.set_halted(false);
  state_ = State::runs;
  lockup_reason_.clear();
  first_fault_.reset();
  ++processor_.counters().resets[static_cast<std::size_t>(cause)];
  if (on_reset) on_reset(cause);
}

void Execution::jump(std::uint32_t address) {
  if (state_ == State::locked_up || state_ == State::exited) return;
  if (state_ != State::runs) processor_.anchor(machine_.timeline.now());
  state_ = State::runs;
  processor_.set_program_counter(address);
}

void Execution::reset_if_requested() {
  if (machine_.reset_requested) reset(machine_.reset_cause);
}

const Counters& Execution::counters() {
  auto& counters = processor_.counters();
  counters.instructions = processor_.instructions() - instructions_before_;
  counters.cycles = processor_.cycles() - cycles_before_;
  counters.duration = machine_.timeline.now() - counting_since_;
  return counters;
}

void Execution::clear_counters() {
  processor_.clear_counters();
  cycles_before_ = processor_.cycles();
  instructions_before_ = processor_.instructions();
  counting_since_ = machine_.timeline.now();
}

Stop Execution::run_until(Ticks when) {
  running_ = true;
  stop_requested_ = false;
  const Stop stop = run_slices(when);
  running_ = false;
  return stop;
}

Stop Execution::run_slices(Ticks when) {
  auto& timeline = machine_.timeline;
  for (;;) {
    if (state_ == State::runs) timeline.catch_up(processor_.now());
    // The circuit advances now, because the processor is already stopped.
    machine_.advance_circuit(Machine::advance_period / 2);
    reset_if_requested();
    if (stop_requested_) return Stop::requested;
    if (std::exchange(stopped_by_debugger_, false)) return Stop::debugger;
    if (state_ == State::exited) return Stop::firmware_exit;
    if (state_ == State::locked_up && timeline.now() >= when) return Stop::locked_up;
    if (timeline.now() >= when) return Stop::time_reached;

    if (core_is_stalled()) {
      stall_until(when, machine_.clock_is_lost ? never : machine_.core_stalls_until);
      continue;
    }
    if (state_ != State::runs) {
      if (wakes()) {
        state_ = State::runs;
        processor_.anchor(timeline.now());
        exception_may_be_due_ = true;
      } else {
        sleep_until(when);
        continue;
      }
    }
    // While the flash is busy, its vectors and instructions cannot be read. The end of the flash operation is a wake
    // event.
    if (flash_.busy() && machine_.memory.is_in_flash(system_control_.vector_table())) {
      stall_until(when, never);
      continue;
    }
    if (machine_.nvic.take_newly_pending() && system_control_.sends_event_on_pending()) processor_.set_event_register();
    exception_may_be_due_ |= processor_.take_masks_opened();
    // During a debugger step, interrupts stay pending.
    if (!machine_.debugging.steps) {
      exception_may_be_due_ |= machine_.nvic.take_changed();
      if (std::exchange(exception_may_be_due_, false)) take_exception();
    }
    if (state_ != State::runs) continue;
    if (processor_.waits_for_flash()) {
      stall_until(when, never);
      continue;
    }
    if (thread_is_stalled()) {
      stall_until(when, machine_.thread_stalls_until);
      continue;
    }

    const Ticks stop_at = std::min({timeline.next_wake(), when, machine_.last_advance + Machine::advance_period});
    handle(processor_.run(processor_.cycles_until(stop_at)));
  }
}

void Execution::take_exception() {
  const Masks masks = processor_.masks();
  const unsigned exception = machine_.nvic.next(masks);
  if (exception != exception_none) enter(exception);
  // If only PRIMASK, FAULTMASK or BASEPRI block a pending exception, the processor must watch the masks.
  const unsigned next = machine_.nvic.most_urgent();
  processor_.watch_masks(next != exception_none &&
                         machine_.nvic.group_priority(next) < machine_.nvic.execution_priority({}));
}

bool Execution::wakes() const {
  if (state_ == State::locked_up || state_ == State::exited) return false;
  // An interrupt wakes the processor even if PRIMASK is set (ARMv7-M, "Wait For Interrupt").
  Masks masks = processor_.masks();
  masks.primask = false;
  return machine_.nvic.next(masks) != exception_none;
}

// Only the core stops. The cycle counter continues while its clock runs and no debug probe halts the core.
void Execution::stall_until(Ticks when, Ticks goes_on_at) {
  auto& timeline = machine_.timeline;
  const Ticks from = timeline.now();
  Ticks to = std::min({when, goes_on_at, machine_.last_advance + Machine::advance_period});
  if (const Ticks wake = timeline.next_wake(); wake > from) to = std::min(to, wake);
  to = std::max(from, to);
  timeline.catch_up(to);
  if (state_ != State::runs) return;
  const bool counts = !machine_.clock_is_lost && !machine_.debug_halt.halted();
  if (counts) processor_.wait(static_cast<unsigned>(machine_.clocks.hclk.cycles_in(to - from)));
  processor_.anchor(timeline.now());
}

void Execution::sleep_until(Ticks when) {
  auto& timeline = machine_.timeline;
  const Ticks from = timeline.now();
  const Ticks to =
      std::max(from, std::min({timeline.next_wake(), when, machine_.last_advance + Machine::advance_period}));
  timeline.catch_up(to);
  if (state_ == State::sleeps || state_ == State::waits_for_event) processor_.counters().asleep += to - from;
  if (machine_.sleep_counts_cycles) processor_.add_sleep_cycles(machine_.clocks.hclk.cycles_in(to - from));
  if (state_ == State::waits_for_event) {
    if (machine_.nvic.take_newly_pending() && system_control_.sends_event_on_pending()) processor_.set_event_register();
    if (processor_.take_event_register()) {
      state_ = State::runs;
      processor_.anchor(timeline.now());
    }
  }
}

/// Returns true if the exception has a handler. Without a handler, the function enters HardFault or locks up the
/// processor.
bool Execution::has_handler(unsigned exception) {
  const std::uint32_t vector_address = system_control_.vector_table() + 4 * exception;
  const std::uint32_t vector = machine_.memory.word(vector_address);
  if ((vector & 1) != 0) return true;
  const std::string what = "the vector table has no handler for " + name_of(exception) + ": the vector is " +
                           hexadecimal(vector) + at(" at", vector_address, processor_.program_counter());
  note_fault(what);
  system_control_.record_fault(0, scb.hfsr.vecttbl.mask());
  exception == exception_hard_fault ? lock_up(what) : enter(exception_hard_fault);
  return false;
}

void Execution::enter(unsigned exception, bool stacks) {
  if (!has_handler(exception)) return;
  const auto entry =
      processor_.enter_exception(exception, system_control_.aligns_stack(), system_control_.preserves_float_context(),
                                 system_control_.stacks_lazily(), system_control_.vector_table(), stacks);
  if (const auto frame = processor_.take_float_frame()) system_control_.note_float_frame(*frame);
  if (entry != Processor::Entry::started) enter_for_lost_stack(exception, entry == Processor::Entry::protected_stack);
}

// The context that could not be stacked is lost. The stack pointer remains decremented when the handler of the stacking
// fault starts (ARMv7-M, B1.5.9). A less urgent exception stays pending until the fault handler returns.
void Execution::enter_for_lost_stack(unsigned exception, bool is_protected) {
  const std::string what =
      std::string(is_protected ? "the memory protection unit refuses the stack" : "the stack is not in RAM") +
      " at the entry of " + name_of(exception) + ":" +
      at(" stack pointer", processor_.read(UC_ARM_REG_SP), processor_.program_counter());
  note_fault(what);
  auto& nvic = machine_.nvic;
  const unsigned fault = is_protected ? exception_memory_fault : exception_bus_fault;
  system_control_.record_fault(is_protected ? scb.cfsr.mstkerr.mask() : scb.cfsr.stkerr.mask(), 0);
  if (exception == exception_hard_fault || exception == exception_nmi) return lock_up(what);
  if (exception != fault) nvic.pend(exception);
  if (exception != fault && nvic.enabled(fault) && nvic.group_priority(fault) <= nvic.group_priority(exception))
    return enter(fault, false);
  system_control_.record_fault(0, scb.hfsr.forced.mask());
  machine_.log.say_once("HardFault: " + what);
  enter(exception_hard_fault, false);
}

// A fault inside a fault handler is not recorded, because it would hide the original cause.
void Execution::note_fault(const std::string& what) {
  for (const unsigned handler :
       {exception_hard_fault, exception_memory_fault, exception_bus_fault, exception_usage_fault})
    if (machine_.nvic.active(handler) && first_fault_) return;
  if (first_fault_ && first_fault_->when == processor_.now()) return;  // escalation of the same fault
  first_fault_ = Fault{what, processor_.now(), processor_.core_registers()};
}

void Execution::lock_up(const std::string& what) {
  state_ = State::locked_up;
  lockup_reason_ = "The processor has locked up: " + what + ".";
  machine_.log.say(lockup_reason_);
}

void Execution::raise_fault(unsigned exception, std::uint32_t configurable_bits, const std::string& what) {
  note_fault(what);
  auto& nvic = machine_.nvic;
  const int priority = nvic.execution_priority(processor_.masks());
  system_control_.record_fault(configurable_bits, 0);
  if (exception != exception_hard_fault && nvic.enabled(exception) && nvic.group_priority(exception) < priority)
    return enter(exception);
  if (priority <= -1) return lock_up(what);
  if (exception != exception_hard_fault) system_control_.record_fault(0, scb.hfsr.forced.mask());
  machine_.log.say_once("HardFault: " + what);
  enter(exception_hard_fault);
}

void Execution::handle_breakpoint() {
  const std::uint32_t address = processor_.program_counter();
  if (machine_.memory.half_word(address) != semihosting_breakpoint) {
    if (machine_.debugging.attached) {
      machine_.debugging.last_stop = {DebugStop::Reason::breakpoint, 0};
      machine_.debugging.steps = false;
      stopped_by_debugger_ = true;
      return;
    }
    // Without a debugger, a BKPT instruction raises HardFault (ARMv7-M, C1.4.1).
    system_control_.record_fault(0, scb.hfsr.debugevt.mask());
    return raise_fault(exception_hard_fault, 0, at("breakpoint without a debugger at", address, address));
  }
  const std::uint32_t operation = processor_.read(UC_ARM_REG_R0);
  if (operation == semihosting_poll_order && address - system_base < system_bytes) {
    order_boot_loader();
    return processor_.set_program_counter(address + 2);
  }
  const auto answer = semihosting_call(operation, processor_.read(UC_ARM_REG_R1), machine_.memory, on_console);
  if (!answer.known)
    machine_.log.say_once("semihosting call " + std::to_string(operation) + " is not modeled and returns -1");
  processor_.write(UC_ARM_REG_R0, answer.result);
  processor_.set_program_counter(address + 2);
  if (answer.exit_code) {
    exit_code_ = *answer.exit_code;
    state_ = State::exited;
  }
}

void Execution::order_boot_loader() {
  const LoaderOrder order = on_boot_loader();
  const auto bytes = static_cast<std::uint32_t>(order.data.size());
  if (auto* buffer = machine_.memory.ram_at(loader_buffer, bytes); buffer != nullptr && bytes != 0)
    std::memcpy(buffer, order.data.data(), bytes);
  processor_.write(UC_ARM_REG_R0, static_cast<std::uint32_t>(order.kind));
  processor_.write(UC_ARM_REG_R1, order.address);
  processor_.write(UC_ARM_REG_R2, order.kind == LoaderOrder::Kind::program ? loader_buffer : order.word);
  processor_.write(UC_ARM_REG_R3, bytes / 4);
}

// The unreadable frame remains on the stack, and the fault handler reuses this frame (ARMv7-M, B1.5.8 and B1.5.9).
void Execution::handle_lost_frame(bool is_protected) {
  const std::string what = is_protected ? "the memory protection unit refuses the stack at the end of an exception"
                                        : "the stack is not in RAM at the end of an exception";
  note_fault(what + at(": stack pointer", processor_.read(UC_ARM_REG_SP), processor_.program_counter()));
  system_control_.record_fault(is_protected ? scb.cfsr.munstkerr.mask() : scb.cfsr.unstkerr.mask(), 0);
  auto& nvic = machine_.nvic;
  unsigned fault = is_protected ? exception_memory_fault : exception_bus_fault;
  const int priority = nvic.execution_priority(processor_.masks());
  if (!nvic.enabled(fault) || nvic.group_priority(fault) >= priority) {
    if (priority <= -1) return lock_up(what);
    fault = exception_hard_fault;
    system_control_.record_fault(0, scb.hfsr.forced.mask());
    machine_.log.say_once("HardFault: " + what);
  }
  if (has_handler(fault)) processor_.chain_exception(fault, system_control_.vector_table());
}

// Handles a lazy stacking failure. If the fault cannot preempt the running handler, the fault stays pending and the FPU
// context is lost (ARMv7-M, B1.5.7).
void Execution::handle_lost_float_context(bool is_protected) {
  const unsigned fault = is_protected ? exception_memory_fault : exception_bus_fault;
  const std::uint32_t bits = is_protected ? scb.cfsr.mlsperr.mask() : scb.cfsr.lsperr.mask();
  auto& nvic = machine_.nvic;
  if (nvic.enabled(fault) && nvic.group_priority(fault) >= nvic.execution_priority(processor_.masks())) {
    system_control_.record_fault(bits, 0);
    nvic.pend(fault);
    return processor_.drop_lazy_stacking();
  }
  raise_fault(fault, bits,
              at(is_protected ? "the memory protection unit refuses lazy stacking at" : "lazy stacking fails at",
                 processor_.program_counter(), processor_.program_counter()));
}

void Execution::handle_return() {
  switch (processor_.return_from_exception(system_control_.vector_table())) {
    case Processor::Return::done: break;
    case Processor::Return::invalid:
      return raise_fault(exception_usage_fault, scb.cfsr.invpc.mask(),
                         at("invalid EXC_RETURN", processor_.fault_address(), processor_.program_counter()));
    case Processor::Return::no_stack: return handle_lost_frame(false);
    case Processor::Return::protected_stack: return handle_lost_frame(true);
  }
  processor_.watch_masks(false);
  if (processor_.is_in_thread() && system_control_.sleeps_on_exit()) state_ = State::sleeps;
}

void Execution::handle(Outcome outcome) {
  const std::uint32_t address = processor_.fault_address(), program_counter = processor_.program_counter();
  switch (outcome) {
    case Outcome::slice_over: break;
    case Outcome::debugger: stopped_by_debugger_ = true; return;
    case Outcome::wait_for_interrupt: state_ = State::sleeps; break;
    case Outcome::wait_for_event:
      if (!processor_.take_event_register()) state_ = State::waits_for_event;
      break;
    case Outcome::supervisor_call:
      if (machine_.nvic.group_priority(exception_svcall) < machine_.nvic.execution_priority(processor_.masks()))
        enter(exception_svcall);
      else
        raise_fault(exception_hard_fault, 0, at("SVC that cannot be handled before", program_counter, program_counter));
      break;
    case Outcome::breakpoint: handle_breakpoint(); break;
    case Outcome::exception_return: handle_return(); break;
    case Outcome::undefined_instruction:
      raise_fault(exception_usage_fault, scb.cfsr.undefinstr.mask(),
                  at("undefined instruction at", program_counter, program_counter));
      break;
    case Outcome::invalid_state:
      raise_fault(exception_usage_fault, scb.cfsr.invstate.mask(),
                  at("branch out of Thumb state to", program_counter, program_counter));
      break;
    case Outcome::no_coprocessor:
      raise_fault(exception_usage_fault, scb.cfsr.nocp.mask(),
                  at("coprocessor instruction at", program_counter, program_counter));
      break;
    case Outcome::division_by_zero:
      raise_fault(exception_usage_fault, scb.cfsr.divbyzero.mask(),
                  at("division by zero at", program_counter, program_counter));
      break;
    case Outcome::data_fault:
      system_control_.record_bus_fault_address(address);
      raise_fault(exception_bus_fault, scb.cfsr.preciserr.mask() | scb.cfsr.bfarvalid.mask(),
                  at("nothing answers on the bus at", address, program_counter));
      break;
    case Outcome::protected_data:
      system_control_.record_memory_fault_address(address);
      raise_fault(exception_memory_fault, scb.cfsr.daccviol.mask() | scb.cfsr.mmarvalid.mask(),
                  at("the memory protection unit refuses", address, program_counter));
      break;
    case Outcome::float_context_lost: handle_lost_float_context(false); break;
    case Outcome::float_context_protected: handle_lost_float_context(true); break;
    case Outcome::misaligned:
      raise_fault(exception_usage_fault, scb.cfsr.unaligned.mask(),
                  at("an access that is not aligned to", address, program_counter));
      break;
    case Outcome::instruction_fault:
      raise_fault(exception_bus_fault, scb.cfsr.ibuserr.mask(), at("no instructions at", address, program_counter));
      break;
    case Outcome::execute_never:
      raise_fault(exception_memory_fault, scb.cfsr.iaccviol.mask(),
                  at("no instructions may be at", address, program_counter));
      break;
  }
  // Exception entry, exception return and sleep may change the next exception to run.
  if (outcome == Outcome::slice_over || state_ != State::runs) return;
  if (machine_.debugging.steps || stopped_by_debugger_)
    exception_may_be_due_ = true;
  else
    take_exception();
}

}  // namespace inkwell::virtual_board
