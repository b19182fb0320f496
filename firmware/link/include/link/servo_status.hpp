// What the main loop may know about the control interrupt.
#pragma once

#include <cstdint>

#include <link/shared.hpp>
#include <protocol/faults.hpp>

namespace inkwell::link {

/// Written at the end of every control interrupt, read by the main loop.
class ServoStatus {
 public:
  // ---- control interrupt ----

  /// `cycles`: processor cycles of this interrupt; `overrun`: it did not finish within its period.
  void record(protocol::State state, std::uint32_t cycles, bool overrun) {
    state_.store(state);
    if (cycles > longest_cycles_.load()) longest_cycles_.store(cycles);
    if (overrun) overruns_.store(overruns_.load() + 1u);
  }

  // ---- main loop ----

  protocol::State state() const { return state_.load(); }
  std::uint32_t longest_cycles() const { return longest_cycles_.load(); }
  std::uint32_t overruns() const { return overruns_.load(); }

 private:
  Shared<protocol::State> state_{protocol::State::starting};
  Shared<std::uint32_t> longest_cycles_{0};
  Shared<std::uint32_t> overruns_{0};
};

}  // namespace inkwell::link
