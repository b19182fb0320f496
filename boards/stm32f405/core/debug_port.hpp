// Debug access to the processor. Board time does not advance during an access.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

/// Core registers without the FPU registers.
struct CoreRegisters {
  std::array<std::uint32_t, 16> general{};  ///< R0 to R12, SP, LR, PC
  std::uint32_t xpsr = 0;
  static constexpr unsigned sp = 13, lr = 14, pc = 15;
};

struct FloatRegisters {
  std::array<std::uint64_t, 16> doubles{};  ///< D0 to D15; each consists of two of S0 to S31
  std::uint32_t fpscr = 0;
};

struct WatchPoint {
  std::uint32_t address = 0, bytes = 0;
  bool on_read = false, on_write = false;
  bool operator==(const WatchPoint&) const = default;
};

/// Reason why run_until() returned Stop::debugger.
struct DebugStop {
  enum class Reason : std::uint8_t {
    breakpoint,   ///< before the instruction at that address, or at a BKPT instruction
    watch_point,  ///< after the instruction that accessed the address
    step,
  };
  Reason reason = Reason::step;
  std::uint32_t address = 0;  ///< accessed address, for watch points
};

/// Debugger interface of a chip. Use exact mode, because in fast mode the processor stops only between blocks. Do not
/// call these functions during run_until().
class DebugPort {
 public:
  virtual ~DebugPort() = default;
  /// After attach(), BKPT instructions stop the processor. Firmware can detect an attached debugger.
  virtual void attach() = 0;
  /// Removes all breakpoints and watch points.
  virtual void detach() = 0;

  virtual CoreRegisters core_registers() const = 0;
  /// Sets the core registers. In xPSR, the function changes only the flags.
  virtual void set_core_registers(const CoreRegisters& registers) = 0;
  virtual FloatRegisters float_registers() const = 0;
  virtual void set_float_registers(const FloatRegisters& registers) = 0;

  /// Reads memory or peripheral registers. Register reads can have side effects. Returns false for an unmapped address.
  virtual bool read(std::uint32_t address, std::span<std::uint8_t> bytes) = 0;
  /// Writes RAM or peripheral registers. Returns false if the address is not writable.
  virtual bool write(std::uint32_t address, std::span<const std::uint8_t> bytes) = 0;

  virtual void add_breakpoint(std::uint32_t address) = 0;
  virtual void remove_breakpoint(std::uint32_t address) = 0;
  virtual void add_watch_point(const WatchPoint& watch_point) = 0;
  virtual void remove_watch_point(const WatchPoint& watch_point) = 0;

  /// The next run_until() ignores a breakpoint at the current address.
  virtual void resume() = 0;
  /// The next run_until() executes one instruction or one complete if-then block. No interrupt handler runs.
  virtual void step() = 0;
  virtual DebugStop last_stop() const = 0;
};

}  // namespace inkwell::virtual_board
