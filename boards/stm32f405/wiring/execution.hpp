// Execution of the firmware: processor slices, exceptions, faults, sleep, resets.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "boards/stm32f405/core/machine.hpp"
#include "boards/stm32f405/core/processor.hpp"
#include "boards/stm32f405/core/system_control.hpp"
#include "boards/stm32f405/memory/bus.hpp"
#include "boards/stm32f405/memory/flash.hpp"
#include "boards/stm32f405/peripherals/rcc.hpp"
#include "boards/stm32f405/wiring/chip.hpp"

namespace inkwell::virtual_board {

class Execution {
 public:
  Execution(Machine& machine, Processor& processor, Bus& bus, const FlashController& flash,
            SystemControl& system_control, Rcc& rcc)
      : machine_(machine),
        processor_(processor),
        bus_(bus),
        flash_(flash),
        system_control_(system_control),
        rcc_(rcc) {}

  Stop run_until(Ticks when);
  void reset(ResetCause cause);
  void jump(std::uint32_t address);
  void stall(Ticks duration) { machine_.core_stalls_until = machine_.timeline.now() + duration; }
  void stall_thread(Ticks duration) { machine_.thread_stalls_until = machine_.timeline.now() + duration; }
  void halt(Ticks duration) {
    stall(duration);
    machine_.debug_halt.set_halted(true);
  }
  void request_stop() {
    stop_requested_ = true;
    if (running_) processor_.end_slice();
  }
  bool running() const { return running_; }
  const Counters& counters();
  void clear_counters();
  int exit_code() const { return exit_code_; }
  const std::string& lockup_reason() const { return lockup_reason_; }
  const std::optional<Fault>& first_fault() const { return first_fault_; }

  std::function<void(std::uint8_t)> on_console;
  std::function<void(ResetCause)> on_reset;
  std::function<LoaderOrder()> on_boot_loader;

 private:
  enum class State : std::uint8_t { runs, sleeps, waits_for_event, locked_up, exited };
  Stop run_slices(Ticks when);
  void reset_if_requested();
  void take_exception();
  void sleep_until(Ticks when);
  bool core_is_stalled() const {
    return machine_.clock_is_lost || machine_.core_stalls_until > machine_.timeline.now();
  }
  bool thread_is_stalled() const {
    return machine_.thread_stalls_until > machine_.timeline.now() && processor_.is_in_thread() &&
           processor_.masks().are_open();
  }
  /// Stops the core until `goes_on_at`, or for a limited time if `goes_on_at` is `never`.
  void stall_until(Ticks when, Ticks goes_on_at);
  bool wakes() const;
  void handle(Outcome outcome);
  void handle_breakpoint();
  void order_boot_loader();
  void handle_return();
  void raise_fault(unsigned exception, std::uint32_t configurable_bits, const std::string& what);
  void enter(unsigned exception, bool stacks = true);
  bool has_handler(unsigned exception);
  void handle_lost_frame(bool is_protected);
  void handle_lost_float_context(bool is_protected);
  void enter_for_lost_stack(unsigned exception, bool is_protected);
  void note_fault(const std::string& what);
  void lock_up(const std::string& what);

  Machine& machine_;
  Processor& processor_;
  Bus& bus_;
  const FlashController& flash_;
  SystemControl& system_control_;
  Rcc& rcc_;
  State state_ = State::runs;
  bool running_ = false, stop_requested_ = false, stopped_by_debugger_ = false;
  bool exception_may_be_due_ = false;  ///< the execution state has changed since the last check for exceptions
  int exit_code_ = 0;
  std::string lockup_reason_;
  std::optional<Fault> first_fault_;
  Ticks counting_since_ = 0;
  std::uint64_t cycles_before_ = 0, instructions_before_ = 0;
};

}  // namespace inkwell::virtual_board
