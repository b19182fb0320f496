// What a debug probe does to the processor: look, change, stop. Board time stands still meanwhile.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

/// What the core's programmer sees, without the FPU.
struct CoreRegisters {
  std::array<std::uint32_t, 16> general{};  ///< R0 to R12, SP, LR, PC
  std::uint32_t xpsr = 0;
  static constexpr unsigned sp = 13, lr = 14, pc = 15;
};

struct FloatRegisters {
  std::array<std::uint64_t, 16> doubles{};  ///< D0 to D15: two of S0 to S31 each
  std::uint32_t fpscr = 0;
};

struct WatchPoint {
  std::uint32_t address = 0, bytes = 0;
  bool on_read = false, on_write = false;
  bool operator==(const WatchPoint&) const = default;
};

/// Why run_until() came back with Stop::debugger.
struct DebugStop {
  enum class Reason : std::uint8_t {
    breakpoint,   ///< before the instruction there; also at a BKPT instruction
    watch_point,  ///< after the instruction that touched it
    step,
  };
  Reason reason = Reason::step;
  std::uint32_t address = 0;  ///< that was touched, of a watch point
};

/// Of a chip in exact mode: in fast mode the processor is stopped between blocks only. Not from inside run_until().
class DebugPort {
 public:
  virtual ~DebugPort() = default;
  /// From now on BKPT instructions stop the processor, and firmware can read that a debugger is there.
  virtual void attach() = 0;
  /// Forgets breakpoints and watch points.
  virtual void detach() = 0;

  virtual CoreRegisters core_registers() const = 0;
  /// Of xPSR the flags only.
  virtual void set_core_registers(const CoreRegisters& registers) = 0;
  virtual FloatRegisters float_registers() const = 0;
  virtual void set_float_registers(const FloatRegisters& registers) = 0;

  /// Memory, or registers of peripherals with what reading them does there. False: nothing is there.
  virtual bool read(std::uint32_t address, std::span<std::uint8_t> bytes) = 0;
  /// RAM, or registers of peripherals. False: nothing that can be written is there.
  virtual bool write(std::uint32_t address, std::span<const std::uint8_t> bytes) = 0;

  virtual void add_breakpoint(std::uint32_t address) = 0;
  virtual void remove_breakpoint(std::uint32_t address) = 0;
  virtual void add_watch_point(const WatchPoint& watch_point) = 0;
  virtual void remove_watch_point(const WatchPoint& watch_point) = 0;

  /// The next run_until() goes on from here, past a breakpoint at this very place.
  virtual void resume() = 0;
  /// The next run_until() executes one instruction, or an if-then block as a whole. Interrupts wait meanwhile.
  virtual void step() = 0;
  virtual DebugStop last_stop() const = 0;
};

}  // namespace inkwell::virtual_board
