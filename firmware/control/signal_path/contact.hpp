// Contact of a sphere with the walls of a box (paper, sections 3.2 and 3.3).
#pragma once

#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// Range of the sphere center without wall contact.
struct Box {
  Vector3 minimum_m;
  Vector3 maximum_m;
};

struct Wall {
  float stiffness_N_per_m;
  float damping_Ns_per_m;
};

struct Contact {
  Vector3 proxy_m;        ///< nearest point of the free space; on the wall while in contact
  Vector3 penetration_m;  ///< proxy minus probe; points out of the wall, zero in free space
};

struct Force {
  Vector3 force_N;  ///< on the hand, workspace axes
  float magnitude_N;
};

/// Clamps the probe position to the free space on each axis. At an edge or a corner, the probe is in contact on two or
/// three axes.
Contact find_contact(const Vector3& probe_m, const Box& box);

/// Signed wall force k d + c d' along one axis. `penetration_m` points out of the wall.
constexpr float axis_force_N(float penetration_m, float velocity_m_per_s, Wall wall) {
  if (penetration_m == 0.0f) return 0.0f;
  const float force_N = wall.stiffness_N_per_m * penetration_m - wall.damping_Ns_per_m * velocity_m_per_s;
  const bool pulls = force_N * penetration_m < 0.0f;
  return pulls ? 0.0f : force_N;
}

/// On each axis in contact, F = (k d + c d') e with penetration d and unit normal e. The force on an axis is zero if
/// the damper would pull the probe into the wall.
constexpr Vector3 wall_force_N(const Contact& contact, const Vector3& velocity_m_per_s, Wall wall) {
  const Vector3& out_m = contact.penetration_m;
  return {axis_force_N(out_m.x, velocity_m_per_s.x, wall), axis_force_N(out_m.y, velocity_m_per_s.y, wall),
          axis_force_N(out_m.z, velocity_m_per_s.z, wall)};
}

/// Limits a force to `limit_N` and keeps its direction. The force is passed by value to stay in registers.
[[gnu::noinline]] Force bounded(Vector3 force_N, float limit_N);

/// Scales a force by the gain of the force ramp.
constexpr Force scaled(const Force& force, float gain) { return {gain * force.force_N, gain * force.magnitude_N}; }

}  // namespace inkwell::control
