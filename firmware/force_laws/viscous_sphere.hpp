// Inside the viscous sphere, a damping force opposes the motion of the probe.
#pragma once

#include <control/force_law.hpp>

namespace inkwell::force_laws {

struct viscous_sphere {
  static constexpr std::string_view help = "A sphere of thick fluid, within the walls of the box.";

  struct Parameters {
    float x_m, y_m, z_m;
    float radius_m;
    float damping_Ns_per_m;
  };
  static constexpr ForceParameter<Parameters> parameter_rows[] = {
      {&Parameters::x_m, "fluid_x_m", "m", -0.3f, 0.3f, 0.0f, "Centre of the sphere, x."},
      {&Parameters::y_m, "fluid_y_m", "m", -0.3f, 0.3f, 0.0f, "Centre of the sphere, y."},
      {&Parameters::z_m, "fluid_z_m", "m", -0.3f, 0.3f, -0.03f, "Centre of the sphere, z."},
      {&Parameters::radius_m, "fluid_radius_m", "m", 0.0f, 0.1f, 0.03f, "Radius of the sphere."},
      {&Parameters::damping_Ns_per_m, "fluid_damping_Ns_per_m", "Ns/m", 0.0f, 10.0f, 4.0f,
       "Force for each metre per second, deep in the fluid."},
  };

  struct Signals {
    float part;
  };
  static constexpr ForceSignal<Signals> signal_rows[] = {
      {&Signals::part, "fluid_part", "", "How much of the damping is felt: 0 outside, 1 deep in the fluid."},
  };

  struct State {};

  /// F = -c v. In the outer fifth of the radius, the damping decreases to zero, so that the force has no step at the
  /// surface.
  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State&, Signals& signals) {
    const Vector3 from_centre_m = probe.position_m - Vector3{parameters.x_m, parameters.y_m, parameters.z_m};
    const float depth_m = parameters.radius_m - __builtin_sqrtf(dot(from_centre_m, from_centre_m));
    const float skin_m = 0.2f * parameters.radius_m;
    signals.part = depth_m <= 0.0f ? 0.0f : depth_m >= skin_m ? 1.0f : depth_m / skin_m;
    return -signals.part * parameters.damping_Ns_per_m * probe.velocity_m_per_s + wall_force_N(probe);
  }
};

}  // namespace inkwell::force_laws
