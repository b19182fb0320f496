#include "firmware/control/signal_path/transition.hpp"

#include "firmware/control/signal_path/trigonometry.hpp"

namespace inkwell::control {

Transition start_transition(const Vector3& jump_N, float N_per_period) {
  // The reciprocal square root needs a normal number.
  constexpr float smallest_squared_N2 = 1e-12f;
  const float squared_N2 = dot(jump_N, jump_N);
  if (squared_N2 < smallest_squared_N2) return {};
  return {jump_N, 1.0f, N_per_period * reciprocal_square_root(squared_N2)};
}

}  // namespace inkwell::control
