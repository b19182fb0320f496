// Dial with detents around an axis of the workspace. The probe turns about the axis and snaps from notch to notch. A
// hysteresis prevents chatter between two notches.
#pragma once

#include <control/force_law.hpp>

namespace inkwell::force_laws {

struct detent_dial {
  static constexpr std::string_view help = "A dial about the vertical line through dial_x_m, dial_y_m, with notches.";

  struct Parameters {
    float x_m, y_m;
    float notch_m;
    float force_N;
  };
  static constexpr ForceParameter<Parameters> parameter_rows[] = {
      {&Parameters::x_m, "dial_x_m", "m", -0.3f, 0.3f, 0.0f, "Axis of the dial, x; it is parallel to z."},
      {&Parameters::y_m, "dial_y_m", "m", -0.3f, 0.3f, -0.05f, "Axis of the dial, y."},
      {&Parameters::notch_m, "dial_notch_m", "m", 0.002f, 0.05f, 0.01f,
       "From notch to notch, along the way of the probe."},
      {&Parameters::force_N, "dial_force_N", "N", 0.0f, 3.0f, 0.8f, "Largest force of a notch."},
  };

  struct Signals {
    float passed_notches;
    float way_m;
  };
  static constexpr ForceSignal<Signals> signal_rows[] = {
      {&Signals::passed_notches, "dial_passed_notches", "",
       "Notches passed since the force is on, backward ones negative."},
      {&Signals::way_m, "dial_way_m", "m", "From the middle of the present notch, along the way of the probe."},
  };

  struct State {
    float passed_notches = 0.0f;
    float way_m = 0.0f;
  };

  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State& state, Signals& signals) {
    const float x_m = probe.position_m.x - parameters.x_m;
    const float y_m = probe.position_m.y - parameters.y_m;
    const float radius_m = __builtin_sqrtf(x_m * x_m + y_m * y_m);
    if (radius_m < 0.005f) return wall_force_N(probe);  // on the axis the direction is undefined
    const Vector3 along{-y_m / radius_m, x_m / radius_m, 0.0f};

    state.way_m += protocol::servo_period_s * dot(along, probe.velocity_m_per_s);
    const float change_at_m = 0.6f * parameters.notch_m;  // half a notch would cause chatter
    const float step = state.way_m > change_at_m ? 1.0f : state.way_m < -change_at_m ? -1.0f : 0.0f;
    state.passed_notches += step;
    state.way_m -= step * parameters.notch_m;

    signals.passed_notches = state.passed_notches;
    signals.way_m = state.way_m;
    constexpr float turn_rad = 6.2831853f;
    const float sine = sine_cosine(clamp(state.way_m / parameters.notch_m, -1.0f, 1.0f) * turn_rad).sine;
    return -parameters.force_N * sine * along + wall_force_N(probe);
  }
};

}  // namespace inkwell::force_laws
