// An STM32F405 for any firmware: Cortex-M4F processor, memories, and the peripherals of RM0090.
//
// Instructions cost the cycles that the core's pipeline, the flash and the buses take (timing/costs.hpp); the clock
// tree, timers, converters, and watchdogs run in board time. `Chip` is not thread-safe: everything, the circuit
// included, runs in the thread that calls run_until().
#pragma once

#include <array>
#include <chip/chip_error.hpp>
#include <chip/debug_port.hpp>
#include <chip/exception_numbers.hpp>
#include <chip/interfaces.hpp>
#include <chip/loader_order.hpp>
#include <chip/violations.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <timing/costs.hpp>
#include <vector>

namespace inkwell::virtual_board {

enum class Mode : std::uint8_t {
  exact,  ///< an interrupt can fall at any instruction
  fast,   ///< interrupts fall between basic blocks; several times faster
};

struct ChipOptions {
  Mode mode = Mode::fast;
  Pricing pricing = Pricing::likely;
  std::uint32_t crystal_Hz = 8'000'000;          ///< HSE, by its name
  std::int32_t crystal_ppm = 0;                  ///< and how much faster than that it swings
  std::uint32_t low_speed_internal_Hz = 32'000;  ///< LSI: 17 to 47 kHz by the data sheet
  unsigned brown_out_level = 0;                  ///< of the option bytes: 0 is off, as in a new chip, to 3
  bool slowest_flash = false;                    ///< the data sheet's longest times to erase and program, not the usual
  std::array<std::uint32_t, 3> unique_id{0x0031'0042, 0x3133'5107, 0x3932'3539};  ///< RM0090, "Unique device ID"
  std::uint32_t random_seed = 1;  ///< of the RNG peripheral, and of what a reset leaves in the flash that was busy
  /// Takes each line of the log (without a newline); by default it goes to stderr.
  std::function<void(const std::string&)> log;
  /// The function at an address, for lines of the log; may give nothing. By default there are no names.
  std::function<std::string(std::uint32_t address)> name_of_code;
  /// Called in exact mode before each instruction with the cycles that the processor has run.
  std::function<void(std::uint32_t address, std::uint64_t cycles)> on_instruction;
};

/// RCC_CSR's reset flags, in the order of its bits 26..31, and its bit 25.
enum class ResetCause : std::uint8_t {
  pin,
  power_on,
  software,
  independent_watchdog,
  window_watchdog,
  low_power,
  brown_out
};
inline constexpr std::size_t reset_causes = 7;

struct ExceptionCounters {
  std::uint64_t count = 0;
  /// Cycles of the longest run, entry and return included, without those of exceptions that preempted it.
  std::uint64_t longest_cycles = 0;
};

/// Since construction, or since clear_counters().
struct Counters {
  std::uint64_t instructions = 0;
  std::uint64_t cycles = 0;  ///< without sleep
  Ticks duration = 0;
  Ticks asleep = 0;
  std::array<ExceptionCounters, exception_numbers> exceptions{};
  std::array<std::uint32_t, reset_causes> resets{};  ///< by ResetCause
  std::uint32_t all_resets() const { return std::accumulate(resets.begin(), resets.end(), 0u); }
  double sleep_share() const {
    return duration == 0 ? 0.0 : static_cast<double>(asleep) / static_cast<double>(duration);
  }
};

/// Why run_until() came back.
enum class Stop : std::uint8_t {
  time_reached,
  firmware_exit,  ///< semihosting SYS_EXIT or SYS_EXIT_EXTENDED, see exit_code()
  locked_up,  ///< time reached, but the processor is locked up: only reset() or a watchdog helps. See lockup_reason()
  requested,  ///< request_stop()
  debugger,   ///< a breakpoint, a watch point or the end of a step: see debug_port()
};

/// Frequencies that firmware has set up, in Hz; 0 is a clock that stands still.
struct Clocks {
  std::uint32_t system_Hz, hclk_Hz, pclk1_Hz, pclk2_Hz;
  std::uint32_t timer1_Hz;  ///< timers on APB1
  std::uint32_t timer2_Hz;  ///< timers on APB2
  std::uint32_t usb_Hz;     ///< PLL48CLK
};

/// A fault as the processor met it.
struct Fault {
  std::string what;  ///< cause and addresses
  Ticks when = 0;
  CoreRegisters registers;  ///< before the fault's handler was entered; R0 to R3, R12, LR, PC, XPSR are what it stacks
};

class Chip {
 public:
  /// `circuit` must outlive the chip.
  explicit Chip(Circuit& circuit, const ChipOptions& options = {});
  ~Chip();
  Chip(const Chip&) = delete;
  Chip& operator=(const Chip&) = delete;

  /// Erases the sectors of the flash that the ELF's load segments touch, and programs those by their physical
  /// addresses. Call reset() afterwards. Throws ChipError if the file is missing, truncated, not a 32-bit ARM
  /// executable, or does not fit.
  void load_elf(const std::filesystem::path& path);
  /// Resets processor and peripherals as the pin NRST does (board time goes on).
  void reset(ResetCause cause = ResetCause::pin);

  /// Runs until board time reaches `when`, or the firmware exits. Calls of the circuit, of
  /// peripherals and of scheduled events come from inside it.
  Stop run_until(Ticks when);
  /// Lets the boot loader in the chip start the firmware, after a reset, as it does when it is told to go there
  /// (AN2606): with clocks, CCM and vector table as a loader may leave them, which is not as a reset does.
  void start_by_boot_loader();
  /// Lets the boot loader run, after a reset, as the chip does that comes out of it with BOOT0 high.
  void start_boot_loader();
  /// Sets the program counter, as a debugger does between two instructions, or a particle that flips a bit of it.
  /// Not from inside run_until().
  void jump(std::uint32_t address);
  // Faults that are put into it, not from inside run_until(). A reset ends a stall and a halt; the others last.
  /// The core does nothing for this long, as when the bus keeps it waiting; all else goes on.
  void stall(Ticks duration);
  /// The program comes no further for this long, as in a loop that does not end; exceptions are handled all the same.
  /// Where the program holds exceptions back it still goes on, to where it lets them come.
  void stall_thread(Ticks duration);
  /// A debug probe halts the core for this long; what firmware asked for in DBGMCU_APBx_FZ stands still too. Unlike the
  /// halts of debug_port(), in which all of board time stands.
  void halt(Ticks duration);
  /// For this long the pin is the opposite of what the circuit drives, as by a spike that couples into its wire.
  void glitch(char port, unsigned pin, Ticks duration);
  /// An exception by number that never reaches the core, or does again.
  void lose_exception(unsigned exception, bool lost);
  /// An exception that reaches the core so many cycles of HCLK late, from the next time on; 0 is in time again.
  void delay_exception(unsigned exception, std::uint32_t cycles);
  /// Turns a bit of a byte of RAM or flash over, as a particle does. False if there is no memory.
  [[nodiscard]] bool flip_bit(std::uint32_t address, unsigned bit);
  /// ADC `number` (1 to 3) begins no conversion any more, or does again.
  void stop_converter(unsigned number, bool stopped);
  /// Neither DMA takes a request any more, or both do again.
  void stop_dma(bool stopped);
  /// The power fails in the middle of so many erases and programmed words from now on, and is back at once; 0 is never.
  void cut_power_at_flash_operation(std::uint64_t number);
  /// Erases and programmed words since the chip was made.
  std::uint64_t flash_operations() const;
  /// The supply of the chip, 3.3 V to begin with. Below the brown-out level of the option bytes it is held in reset.
  /// VDDA goes with it.
  void set_supply_V(double volts);
  /// VDDA alone, the reference of the converters.
  void set_analog_supply_V(double volts);
  /// The crystal stops, or swings again.
  void let_crystal_swing(bool swings);
  /// It swings faster than its name by so many parts in a million; ChipOptions::crystal_ppm to begin with.
  void drift_crystal(std::int32_t ppm);
  /// The exception that runs; 0 in thread mode.
  unsigned current_exception() const;

  /// From inside a callback: run_until() returns as soon as it can.
  void request_stop();

  Scheduler& scheduler();
  DebugPort& debug_port();
  InterruptController& interrupts();
  InputPins& input_pins();
  /// What a meter would show at a pin ('A' to 'I', 0 to 15), and what the chip itself puts out there.
  PinLevel pin_level(char port, unsigned pin) const;
  PinLevel pin_output(char port, unsigned pin) const;
  ChipConnections connections();

  /// Puts a peripheral on the bus; `base` is a multiple of 1024 in 0x40000000..0x400803FF or
  /// 0x50000000..0x50060BFF. It is reset with the chip. It must outlive the chip.
  void add_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name, Peripheral& peripheral);

  /// Called at the trigger of each injected sequence of the ADCs with its index since reset. ADCs that are
  /// triggered at the same instant count once.
  std::function<void(std::uint64_t index, Ticks when)> on_injected_sequence;
  /// A character that semihosting writes (SYS_WRITE0, SYS_WRITEC, SYS_WRITE) or any USART sends.
  std::function<void(std::uint8_t byte)> on_console;
  /// A character that USART `number` (1..6) has sent, at the end of its stop bit.
  std::function<void(unsigned number, std::uint8_t byte)> on_usart;
  /// Called at each change of a pin's level. Once it is set, each pin that has one is told. Nothing ends it.
  void watch_pins(std::function<void(char port, unsigned pin, PinLevel level, Ticks when)> changed);
  /// Called when an exception begins to run, and with 0 when the thread goes on. Nothing ends it.
  void watch_exceptions(std::function<void(unsigned exception, Ticks when)> changed);
  /// Called when the firmware breaks a rule, once for each place.
  std::function<void(const Violation& violation)> on_violation;
  /// Called some thousand times a second, and after each order, while the boot loader in the chip runs: what it does
  /// next.
  std::function<LoaderOrder()> on_boot_loader;
  /// Called after each reset that the firmware or a watchdog causes (and those by reset()).
  std::function<void(ResetCause cause)> on_reset;

  /// A character for the receiver of USART `number` (1..6); they follow each other at the baud rate.
  void usart_receive(unsigned number, std::uint8_t byte);
  /// Its receiver is on; what arrives before is lost.
  bool usart_listens(unsigned number) const;
  /// Bytes of usart_receive() that it has not received yet.
  std::size_t usart_waiting(unsigned number) const;

  Ticks now() const;
  Mode mode() const;
  Clocks clocks() const;
  const Counters& counters() const;
  void clear_counters();
  /// Of SYS_EXIT (0 or 1) or SYS_EXIT_EXTENDED, once run_until() returned Stop::firmware_exit.
  int exit_code() const;
  /// Fault and addresses in a sentence, once run_until() returned Stop::locked_up.
  const std::string& lockup_reason() const;
  /// The newest fault that did not come from the handler of another one: what a lock-up began with.
  const std::optional<Fault>& first_fault() const;
  /// Registers of all peripherals, as their models declare them.
  std::vector<RegisterMap> register_maps() const;
  /// Rules that the firmware has broken so far, in the order of their first time.
  const std::vector<Violation>& violations() const;
  /// Lines of unmodelled accesses so far.
  const std::vector<std::string>& unmodelled_accesses() const;

  /// Memory as a debugger sees it (flash, SRAM, CCM; no registers, no side effects). 0 outside of memory.
  std::uint32_t memory_word(std::uint32_t address) const;
  /// All of the flash, as a programmer reads and writes it; reset() has to follow.
  std::span<std::uint8_t> flash();
  /// A number of all of the state that firmware can see in memory and core registers, to compare runs by.
  std::uint64_t state_hash() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace inkwell::virtual_board
