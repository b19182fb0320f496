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

/// Motion of a surface.
struct Motion {
  Vector3 velocity_m_per_s;
  float rise_m = 0.0f;  ///< outward movement of a recessed surface in this period
};

}  // namespace inkwell::control
