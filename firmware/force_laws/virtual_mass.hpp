// This force law calls a C step function with structs. MATLAB Coder, Simulink and Octave users write step functions in
// this form. This file passes the probe to the step function and adds rows for the parameters and outputs of the
// function. The file generated_code/virtual_mass.c needs no changes.
#pragma once

#include <cmath>  // headers of the C code must be included here, outside the namespace

#include <control/force_law.hpp>

namespace inkwell::force_laws {
namespace {
#include "generated_code/virtual_mass.c"
}

struct virtual_mass {
  static constexpr std::string_view help = "A mass on a spring, carried by the probe: C code as it is generated.";

  struct Parameters {
    float mass_kg, stiffness_N_per_m, damping_Ns_per_m;
  };
  static constexpr ForceParameter<Parameters> parameter_rows[] = {
      {&Parameters::mass_kg, "mass_kg", "kg", 0.01f, 2.0f, 0.2f, "Mass that the probe carries."},
      {&Parameters::stiffness_N_per_m, "mass_stiffness_N_per_m", "N/m", 0.0f, 1000.0f, 200.0f,
       "Spring that carries it."},
      {&Parameters::damping_Ns_per_m, "mass_damping_Ns_per_m", "Ns/m", 0.0f, 20.0f, 1.0f, "What slows it down."},
  };

  struct Signals {
    float speed_m_per_s;
  };
  static constexpr ForceSignal<Signals> signal_rows[] = {
      {&Signals::speed_m_per_s, "mass_speed_m_per_s", "m/s", "Speed of the mass."},
  };

  using State = virtual_mass_state;

  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State& state, Signals& signals) {
    const virtual_mass_inputs inputs = {{probe.position_m.x, probe.position_m.y, probe.position_m.z},
                                        protocol::servo_period_s};
    const virtual_mass_parameters given = {parameters.mass_kg, parameters.stiffness_N_per_m,
                                           parameters.damping_Ns_per_m};
    virtual_mass_outputs outputs = {};
    virtual_mass_step(&inputs, &given, &state, &outputs);
    signals.speed_m_per_s = outputs.speed;
    return {outputs.force[0], outputs.force[1], outputs.force[2]};
  }
};

}  // namespace inkwell::force_laws
