// True physical quantities of the simulation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/virtual/plant/arm_dynamics.hpp"
#include "protocol/simulation.hpp"

namespace inkwell::virtual_board {

struct Truth {
  Ticks at = 0;
  Vector3 position_m, velocity_m_s;  ///< probe, workspace
  Vector3 joints_rad, joint_speeds_rad_s;
  Vector3 current_A;      ///< motor currents including ripple
  Vector3 torque_Nm;      ///< of the motors, at the joints
  Vector3 hand_force_N;   ///< of the hand on the probe
  Vector3 hand_target_m;  ///< target of the hand, or the probe if no hand holds the stylus
  double supply_V = 0.0;
  std::array<std::int64_t, 3> encoder_counts{};
  bool hand_holds = false, docked = false, inkwell_switch = false, bridge_fault = false;
  std::array<bool, 2> buttons{};
  bool bridges_enabled = false;                         ///< level of the bridges' enable input
  Ticks driven_until = 0;                               ///< last time at which an enabled bridge drove a leg high
  std::array<std::array<PinLevel, 2>, 3> leg_levels{};  ///< levels that the chip drives at the bridge inputs
};

/// Values of a trace row, in the order of protocol::simulated_quantity_table.
using TracedValues = std::array<double, protocol::simulated_quantity_count>;
TracedValues traced_values(const Truth& truth);

/// The trace has one row per control period. A full trace drops and counts its oldest rows.
class Trace {
 public:
  struct Row {
    std::uint64_t period;  ///< index of the ADC's injected conversion sequence since reset
    Ticks at;
    TracedValues values;
  };
  static constexpr std::size_t rows_maximum = 1'200'000;  // one minute

  void start();
  void stop() { running_ = false; }
  bool is_running() const { return running_; }
  void record(std::uint64_t period, const Truth& truth);
  /// Removes and returns the oldest rows, at most `maximum` rows.
  std::vector<Row> read(std::size_t maximum);
  std::size_t waiting() const { return rows_.size(); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::deque<Row> rows_;
  std::uint64_t dropped_ = 0;
  bool running_ = false;
};

}  // namespace inkwell::virtual_board
