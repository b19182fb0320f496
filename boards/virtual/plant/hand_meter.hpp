// Measures force, energy and motion of the hand over a time interval.
#pragma once

#include <algorithm>

#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/virtual/plant/arm_dynamics.hpp"

namespace inkwell::virtual_board {

class HandMeter {
 public:
  struct Reading {
    Ticks since = 0;
    double peak_force_N = 0.0;
    double energy_J = 0.0;  ///< from the arm to the hand; energy in the other direction is not subtracted
    double travel_m = 0.0;  ///< largest distance from the initial position
    double lag_m = 0.0;     ///< largest distance from the hand's target
  };

  void start(const Vector3& position_m, Ticks now) {
    begin_m_ = newest_m_ = position_m;
    reading_ = {.since = now};
    runs_ = true;
  }
  bool runs() const { return runs_; }
  const Reading& reading() const { return reading_; }

  /// Adds one time step with probe position, hand target and force on the hand.
  void step(const Vector3& position_m, const Vector3& target_m, const Vector3& force_N) {
    reading_.peak_force_N = std::max(reading_.peak_force_N, force_N.norm());
    reading_.energy_J += std::max(0.0, force_N.dot(position_m - newest_m_));
    reading_.travel_m = std::max(reading_.travel_m, (position_m - begin_m_).norm());
    reading_.lag_m = std::max(reading_.lag_m, (position_m - target_m).norm());
    newest_m_ = position_m;
  }

 private:
  bool runs_ = false;
  Vector3 begin_m_, newest_m_;
  Reading reading_;
};

}  // namespace inkwell::virtual_board
