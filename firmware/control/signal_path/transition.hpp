// Smooth transition of the force after a change of the rendered objects.
#pragma once

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// Addition to the rendered force. The added force is initially equal to the jump and decreases linearly to zero (Mark
/// et al., "Adding force feedback to graphics systems", SIGGRAPH 1996).
struct Transition {
  Vector3 jump_N;
  float part = 0.0f;  ///< remaining part of the jump, 1 to 0
  float part_per_period = 0.0f;

  constexpr void advance() { part = part > part_per_period ? part - part_per_period : 0.0f; }
  Vector3 force_N() const { return part * jump_N; }
};

/// `jump_N` is the old force minus the new force. The magnitude of the added force falls by `N_per_period`.
Transition start_transition(const Vector3& jump_N, float N_per_period);

}  // namespace inkwell::control
