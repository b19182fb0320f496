// Requests of a debugger to the processor.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include "boards/stm32f405/core/debug_port.hpp"

namespace inkwell::virtual_board {

struct Debugging {
  bool attached = false;
  bool steps = false;
  std::set<std::uint32_t> breakpoints;
  /// The program resumes at this address. The stop at this address has already been reported.
  std::optional<std::uint32_t> resumed_at;
  /// Watch point address accessed by the current instruction.
  std::optional<std::uint32_t> touched;
  DebugStop last_stop;

  /// Returns true if the processor must stop before the instruction at `address`.
  bool stops_at(std::uint32_t address) const {
    return touched || (steps && !resumed_at) || (resumed_at != address && breakpoints.contains(address));
  }
  void note_stop_at(std::uint32_t address) {
    if (touched)
      last_stop = {DebugStop::Reason::watch_point, *touched};
    else
      last_stop = {breakpoints.contains(address) ? DebugStop::Reason::breakpoint : DebugStop::Reason::step, 0};
    touched.reset();
    steps = false;
  }
};

}  // namespace inkwell::virtual_board
