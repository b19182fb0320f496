// What keeps the force from jumping when what the hand touches changes from one period to the next.
#pragma once

#include <control/vector.hpp>

namespace inkwell::control {

/// A force that is added to what is rendered: as large as the jump when it came, then less each period until it is gone
/// (recovery time: Mark et al., "Adding force feedback to graphics systems", SIGGRAPH 1996).
struct Transition {
  Vector3 jump_N;
  float part = 0.0f;  ///< of the jump that is left, 1 to 0
  float part_per_period = 0.0f;

  Vector3 force_N() const { return part * jump_N; }
};

/// Starts anew over `jump_N`, the force before minus the force after; its magnitude then falls by `N_per_period`.
Transition over(const Vector3& jump_N, float N_per_period);

/// One control period further.
constexpr void advance(Transition& transition) {
  transition.part = transition.part > transition.part_per_period ? transition.part - transition.part_per_period : 0.0f;
}

}  // namespace inkwell::control
