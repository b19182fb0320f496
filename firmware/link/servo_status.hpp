// Status of the control interrupt for the main loop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/exchange/shared.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::link {

class ServoStatus {
 public:
  // ---- control interrupt ----

  /// `motor_heat` is 1 at the continuous current. `cycles` is the duration of this interrupt in processor cycles.
  /// `late_force_reports` is the number of late force reports since start-up. `overrun` is true if the interrupt did
  /// not finish within its period.
  void record(protocol::State state, const std::array<float, 3>& motor_heat, std::uint32_t cycles,
              std::uint32_t late_force_reports, bool overrun) {
    state_.store(state);
    for (std::size_t i = 0; i < motor_heat.size(); ++i) motor_heat_[i].store(motor_heat[i]);
    if (cycles > longest_cycles_.load()) longest_cycles_.store(cycles);
    late_force_reports_.store(late_force_reports);
    if (overrun) overruns_.store(overruns_.load() + 1u);
  }

  // ---- main loop ----

  protocol::State state() const { return state_.load(); }
  float motor_heat(std::size_t motor) const { return motor_heat_[motor].load(); }
  std::uint32_t longest_cycles() const { return longest_cycles_.load(); }
  std::uint32_t late_force_reports() const { return late_force_reports_.load(); }
  std::uint32_t overruns() const { return overruns_.load(); }

 private:
  Shared<protocol::State> state_{protocol::State::starting};
  std::array<Shared<float>, 3> motor_heat_{Shared{0.0f}, Shared{0.0f}, Shared{0.0f}};
  Shared<std::uint32_t> longest_cycles_{0};
  Shared<std::uint32_t> late_force_reports_{0};
  Shared<std::uint32_t> overruns_{0};
};

}  // namespace inkwell::link
