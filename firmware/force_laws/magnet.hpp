// Magnet in the workspace. The magnet attracts the probe. Near its center, the magnet acts like a spring.
#pragma once

#include <control/force_law.hpp>

namespace inkwell::force_laws {

struct magnet {
  static constexpr std::string_view help = "A magnet that pulls the probe, within the walls of the box.";

  struct Parameters {
    float x_m, y_m, z_m;
    float strength_N;
    float reach_m;
  };
  static constexpr ForceParameter<Parameters> parameter_rows[] = {
      {&Parameters::x_m, "magnet_x_m", "m", -0.3f, 0.3f, 0.0f, "Where the magnet is, x."},
      {&Parameters::y_m, "magnet_y_m", "m", -0.3f, 0.3f, 0.0f, "Where the magnet is, y."},
      {&Parameters::z_m, "magnet_z_m", "m", -0.3f, 0.3f, -0.03f, "Where the magnet is, z."},
      {&Parameters::strength_N, "magnet_strength_N", "N", -3.0f, 3.0f, 1.0f,
       "Largest force of the magnet, at magnet_reach_m from it; below 0 it pushes away."},
      {&Parameters::reach_m, "magnet_reach_m", "m", 0.005f, 0.1f, 0.02f,
       "How far from the magnet its force is largest."},
  };

  struct Signals {
    float distance_m;
  };
  static constexpr ForceSignal<Signals> signal_rows[] = {
      {&Signals::distance_m, "magnet_distance_m", "m", "From the probe to the magnet."},
  };

  struct State {};

  /// At a distance d from the magnet, the attracting force is F = F0 (2 d / r) / (1 + (d / r)^2). The force is F0 at
  /// the distance r and zero at the magnet.
  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State&, Signals& signals) {
    const Vector3 to_magnet_m = Vector3{parameters.x_m, parameters.y_m, parameters.z_m} - probe.position_m;
    const float squared_m2 = dot(to_magnet_m, to_magnet_m);
    signals.distance_m = __builtin_sqrtf(squared_m2);
    const float stiffness_N_per_m =
        2.0f * parameters.strength_N * parameters.reach_m / (parameters.reach_m * parameters.reach_m + squared_m2);
    return stiffness_N_per_m * to_magnet_m + wall_force_N(probe);
  }
};

}  // namespace inkwell::force_laws
