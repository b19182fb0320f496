// Largest stable stiffness of a surface, in the closed loop.
#pragma once

#include <cstdint>

#include "tests/contact/closed_loop.hpp"

namespace inkwell::closed_loop {

/// A plate or a ball. The board renders its own shape, or the PC sends local models of a mesh.
enum class Body : std::uint8_t { plane, ball };
enum class Source : std::uint8_t { board, mesh };

/// A hand presses the tip onto a surface with full friction.
struct Press {
  Body body;
  Source source;
  HandModel hand;
  double push_N;
  bool has_arm_friction = true;
  unsigned trials = 1;  ///< with different points, sensor noise and delays
};

/// Stable means that the rms speed of the pressed tip is at most this.
inline constexpr double still_m_per_s = 0.001;
/// Largest stiffness of a surface on the board.
double stiffness_max_N_per_m();

/// Root mean square of the tip's speed after it has settled, over all trials.
double rms_speed_m_per_s(const Press& press, double stiffness_N_per_m);

/// Largest stiffness with a stable contact, in steps of 10 %.
double stable_stiffness_N_per_m(const Press& press);

}  // namespace inkwell::closed_loop
