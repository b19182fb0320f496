// An STM32F405 for any firmware: Cortex-M4F processor, memories, and the peripherals of RM0090.
//
// The duration of an instruction includes the cycles of the core pipeline, the flash and the buses (timing/costs.hpp).
// The clock tree, timers, converters and watchdogs run in board time. `Chip` is not thread-safe: the chip and the
// circuit run in the thread that calls run_until().
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/core/chip_options.hpp"
#include "boards/stm32f405/core/clock.hpp"
#include "boards/stm32f405/core/counters.hpp"
#include "boards/stm32f405/core/debug_port.hpp"
#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/stm32f405/core/rules.hpp"
#include "boards/stm32f405/wiring/loader_order.hpp"

namespace inkwell::virtual_board {

/// Reason why run_until() returned.
enum class Stop : std::uint8_t {
  time_reached,
  firmware_exit,  ///< semihosting SYS_EXIT or SYS_EXIT_EXTENDED; see exit_code()
  locked_up,  ///< time reached with a locked-up processor; only reset() or a watchdog resumes it; see lockup_reason()
  requested,  ///< request_stop()
  debugger,   ///< a breakpoint, a watch point or the end of a step; see debug_port()
};

struct Fault {
  std::string what;  ///< cause and addresses
  Ticks when = 0;
  /// Core registers before the entry of the fault handler. R0 to R3, R12, LR, PC and XPSR are the stacked values.
  CoreRegisters registers;
};

class Chip {
 public:
  /// `circuit` must outlive the chip.
  explicit Chip(Circuit& circuit, const ChipOptions& options = {});
  ~Chip();
  Chip(const Chip&) = delete;
  Chip& operator=(const Chip&) = delete;

  /// Programs the load segments of an ELF file at their physical addresses. The sectors of the segments are erased
  /// first. Call reset() afterwards. Throws ChipError if the file is missing, truncated or too large, or if it is not a
  /// 32-bit ARM executable.
  void load_elf(const std::filesystem::path& path);
  /// Resets processor and peripherals, as a low level at the NRST pin does. Board time continues.
  void reset(ResetCause cause = ResetCause::pin);

  /// Runs until board time reaches `when` or the firmware exits. The function calls the circuit, the peripherals and
  /// the scheduled events.
  Stop run_until(Ticks when);
  /// Starts the firmware with the "go" command of the boot loader (AN2606). Call reset() before start_by_boot_loader().
  /// Clocks, CCM and vector table keep the settings of the boot loader.
  void start_by_boot_loader();
  /// Starts the boot loader, as a reset with BOOT0 high does.
  void start_boot_loader();
  /// Sets the program counter between two instructions. Not allowed inside run_until().
  void jump(std::uint32_t address);
  // Injected faults. Calls are not allowed inside run_until(). A reset clears stall(), stall_thread() and halt(); all
  // other injected faults remain.
  /// Stops the core for `duration`. The peripherals continue.
  void stall(Ticks duration);
  /// Stops thread mode for `duration`. Exceptions are still handled. If the program masks exceptions, thread mode stops
  /// only after the instruction that unmasks the exceptions.
  void stall_thread(Ticks duration);
  /// Halts the core for `duration`, as a debug probe does. The peripherals selected in DBGMCU_APBx_FZ freeze. Board
  /// time continues, in contrast to a halt by debug_port().
  void halt(Ticks duration);
  /// For `duration`, inverts the level that the circuit drives at the pin.
  void glitch(char port, unsigned pin, Ticks duration);
  /// While `lost` is true, the exception does not reach the core.
  void lose_exception(unsigned exception, bool lost);
  /// Delays each further occurrence of an exception by `cycles` of HCLK. A value of 0 removes the delay.
  void delay_exception(unsigned exception, std::uint32_t cycles);
  /// Flips one bit of a byte of RAM or flash. Returns false if there is no memory at `address`.
  [[nodiscard]] bool flip_bit(std::uint32_t address, unsigned bit);
  /// Prevents new conversions of ADC `number` (1 to 3) while `stopped` is true.
  void stop_converter(unsigned number, bool stopped);
  /// Prevents both DMA controllers from accepting requests while `stopped` is true.
  void stop_dma(bool stopped);
  /// Cuts the power in the middle of an erase or program operation. `number` 1 selects the next operation. Power
  /// returns immediately. `number` 0 cancels the power cut.
  void cut_power_at_flash_operation(std::uint64_t number);
  /// Number of erase and program operations since construction.
  std::uint64_t flash_operations() const;
  /// Sets the 3.3 V supply of the chip and VDDA. The chip stays in reset while the supply is below the brown-out level
  /// (option bytes).
  void set_supply_V(double volts);
  /// Sets VDDA alone. VDDA is the reference of the converters.
  void set_analog_supply_V(double volts);
  void let_crystal_swing(bool swings);
  /// Sets the deviation of the crystal from its nominal frequency. The initial value is ChipOptions::crystal_ppm.
  void drift_crystal(std::int32_t ppm);
  /// Number of the running exception; 0 in thread mode.
  unsigned current_exception() const;

  /// Makes run_until() return as soon as possible. Callbacks may call this function.
  void request_stop();

  Scheduler& scheduler();
  DebugPort& debug_port();
  InterruptController& interrupts();
  InputPins& input_pins();
  /// Level at a pin, and output level of the chip. `port` is 'A' to 'I', `pin` 0 to 15.
  PinLevel pin_level(char port, unsigned pin) const;
  PinLevel pin_output(char port, unsigned pin) const;
  ChipConnections connections();

  /// Adds a peripheral to the bus; `base` is a multiple of 1024 in 0x40000000..0x400803FF or 0x50000000..0x50060BFF.
  /// Each chip reset resets the peripheral. `peripheral` must outlive the chip.
  void add_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name, Peripheral& peripheral);

  /// Callback at the trigger of each injected ADC sequence. `index` counts the sequences since reset. Simultaneous
  /// sequences of several ADCs count as one sequence.
  std::function<void(std::uint64_t index, Ticks when)> on_injected_sequence;
  /// Callback for each character from semihosting (SYS_WRITE0, SYS_WRITEC, SYS_WRITE) or from any USART.
  std::function<void(std::uint8_t byte)> on_console;
  /// Callback at the end of each character from USART `number` (1..6).
  std::function<void(unsigned number, std::uint8_t byte)> on_usart;
  /// Calls `changed` at each level change of a pin, and initially for each pin that is not floating. An empty function
  /// stops the calls.
  void watch_pins(std::function<void(char port, unsigned pin, PinLevel level, Ticks when)> changed);
  /// Calls `changed` with the exception number when a handler starts or resumes, and with 0 when thread mode resumes.
  /// An empty function stops the calls.
  void watch_exceptions(std::function<void(unsigned exception, Ticks when)> changed);
  /// Callback for each broken rule, once per combination of rule and peripheral or pin.
  std::function<void(const Violation& violation)> on_violation;
  /// Callback after each order of the boot loader. The callback returns the next order.
  std::function<LoaderOrder()> on_boot_loader;
  /// Callback after each reset of any cause.
  std::function<void(ResetCause cause)> on_reset;

  /// Sends a character to the receiver of USART `number` (1..6). Characters follow each other at the baud rate.
  void usart_receive(unsigned number, std::uint8_t byte);
  /// Returns true if the receiver of USART `number` is on. While the receiver is off, incoming characters are lost.
  bool usart_listens(unsigned number) const;
  /// Number of bytes from usart_receive() that the USART has not received yet.
  std::size_t usart_waiting(unsigned number) const;

  Ticks now() const;
  Mode mode() const;
  Clocks clocks() const;
  const Counters& counters() const;
  void clear_counters();
  /// Exit code from SYS_EXIT (0 or 1) or SYS_EXIT_EXTENDED, valid after Stop::firmware_exit.
  int exit_code() const;
  /// Description of the fault with its addresses, valid after Stop::locked_up.
  const std::string& lockup_reason() const;
  /// Most recent fault outside of fault handlers. If the processor locks up, first_fault() is the cause.
  const std::optional<Fault>& first_fault() const;
  std::vector<RegisterMap> register_maps() const;
  /// Broken rules, in the order of their first violations.
  const std::vector<Violation>& violations() const;
  /// Log lines of accesses to unmodeled registers.
  const std::vector<std::string>& unmodelled_accesses() const;

  /// Returns a word of flash, SRAM or CCM for debuggers, without side effects. Returns 0 for addresses outside of
  /// flash, SRAM and CCM.
  std::uint32_t memory_word(std::uint32_t address) const;
  /// Returns true if SRAM1 is mapped to address 0.
  bool sram1_is_at_zero() const;
  /// Contents of the flash. Call reset() after a change of the contents.
  std::span<std::uint8_t> flash();
  /// Hash of SRAM, CCM, cycle count and core registers.
  std::uint64_t state_hash() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace inkwell::virtual_board
