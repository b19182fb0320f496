// Surface properties of walls, shapes and local models.
#pragma once

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

struct Surface {
  float stiffness_N_per_m;
  float m_per_N;  ///< 1 / stiffness
  float damping_Ns_per_m;
  float static_friction;     ///< bound of the tangential force while sticking, as a part of the normal force
  float dynamic_friction;    ///< the same bound while sliding; not above static_friction
  float viscosity_Ns_per_m;  ///< tangential force per tangential speed; the force does not exceed the normal force
};

/// Limit of the force on the hand. Friction follows the normal force that the hand feels.
struct ForceLimit {
  float limit_N = 0.0f;
  float per_limit_per_N = 0.0f;  ///< 1 / limit; 0 without a limit
};

/// Motion of a surface.
struct Motion {
  Vector3 velocity_m_per_s;
  float rise_m = 0.0f;  ///< outward movement of a recessed surface in this period
};

}  // namespace inkwell::control
