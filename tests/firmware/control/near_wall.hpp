// An arm whose inkwell is near a wall.
#pragma once

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace inkwell::tests {

/// Settings of the paper's arm with undamped walls. The inkwell's pose is 2 mm inside the upper x wall.
inline control::Settings settings_near_wall() {
  using enum protocol::Parameter;
  protocol::ParameterSet set = without_motors(paper_parameters());
  const control::Settings plain = control::prepare(set);
  const control::Vector3 inkwell_m = control::forward_kinematics(plain.encoders.inkwell_rad, plain.arm).position_m;
  set[sphere_radius_m] = 0.0f;
  set[box_minimum_x_m] = 0.05f;
  set[box_maximum_x_m] = inkwell_m.x + 0.002f;
  set[box_minimum_y_m] = -0.2f;
  set[box_maximum_y_m] = 0.2f;
  set[box_minimum_z_m] = -0.2f;
  set[box_maximum_z_m] = 0.2f;
  set[wall_stiffness_N_per_m] = 800.0f;
  set[force_ramp_s] = 0.1f;
  return control::prepare(set);
}

/// An Omni with a force limit of 8 N. At the inkwell, the probe penetrates three walls by `depth_m`.
inline protocol::ParameterSet pressed_into_three_walls(const control::Vector3& depth_m, float stiffness_N_per_m) {
  using enum protocol::Parameter;
  protocol::ParameterSet set = omni_parameters();
  const control::Settings plain = control::prepare(set);
  const control::Vector3 wall_m =
      control::forward_kinematics(plain.encoders.inkwell_rad, plain.arm).position_m - depth_m;
  set[sphere_radius_m] = 0.0f;
  set[box_minimum_x_m] = set[box_minimum_y_m] = set[box_minimum_z_m] = -0.5f;
  set[box_maximum_x_m] = wall_m.x;
  set[box_maximum_y_m] = wall_m.y;
  set[box_maximum_z_m] = wall_m.z;
  set[wall_stiffness_N_per_m] = stiffness_N_per_m;
  set[force_limit_N] = 8.0f;
  return set;
}

inline void run_with_host(control::Controller& controller, const control::Samples& samples,
                          const control::Settings& settings, int periods) {
  for (int i = 0; i < periods; ++i) {
    controller.host_alive();
    run(controller, samples, settings, 1);
  }
}

}  // namespace inkwell::tests
