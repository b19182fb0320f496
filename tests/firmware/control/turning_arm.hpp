// A hand moves this arm in free space while a program requests forces.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace inkwell::tests {

using control::Vector3;
using protocol::Limit;
using protocol::Parameter;
using protocol::Signal;

/// The waist oscillates by 12 degrees at 1 Hz with the force on. There are no walls. The program requests the force
/// `force_N(velocity)`.
struct TurningArm {
  protocol::ParameterSet set = free_space();
  control::Settings settings = control::prepare(set);
  control::Controller controller = tests::active_controller(settings);
  control::Samples samples = tests::samples_at_rest();
  Vector3 position_m = position();
  float delivered_J = 0.0f;
  float largest_change_N = 0.0f;
  std::uint8_t limits = 0;

  static protocol::ParameterSet free_space() {
    protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
    set[Parameter::wall_stiffness_N_per_m] = set[Parameter::wall_damping_Ns_per_m] = 0.0f;
    set[Parameter::program_force_change_N_per_s] = 20'000.0f;
    set[Parameter::force_ramp_s] = 0.0f;
    set[Parameter::voltage_limit_V] = 0.2f;  // with the back-EMF still below the detection of a missing motor
    return set;
  }
  Vector3 three(Signal first) const {
    const auto signals = controller.signals();
    const auto at = [&](std::size_t i) { return signals.values[static_cast<std::size_t>(first) + i]; };
    return {at(0), at(1), at(2)};
  }
  Vector3 position() const { return three(Signal::position_x_m); }

  template <class Law>
  void turn(float duration_s, Law force_N) {
    const auto periods = static_cast<int>(duration_s * protocol::servo_rate_Hz);
    for (int i = 0; i < periods; ++i) {
      const float phase_rad = 6.2832f * static_cast<float>(i) / protocol::servo_rate_Hz;
      samples.encoder_counts[0] = static_cast<std::int32_t>(640.0f * std::sin(phase_rad));
      controller.host_alive();
      if (i % 20 == 0)
        controller.drive({force_N(three(Signal::velocity_x_m_s)), protocol::ForceMode::beside_walls, 20, 0.05f},
                         settings);
      const Vector3 felt_N = three(Signal::force_x_N);
      tests::run(controller, samples, settings, 1);
      const Vector3 now_m = position();
      delivered_J += dot(felt_N, now_m - position_m);
      position_m = now_m;
      const Vector3 change_N = three(Signal::force_x_N) - felt_N;
      largest_change_N = std::max(largest_change_N, std::sqrt(dot(change_N, change_N)));
      limits |= controller.limits();
    }
    CAPTURE(protocol::info(controller.fault()).name);
    REQUIRE(controller.force_is_on());
  }
  bool reached(Limit limit) const { return protocol::is_reached(limits, limit); }
};

/// Returns a force with or against the motion, or zero at rest.
inline Vector3 along(const Vector3& velocity_m_per_s, float force_N) {
  const float speed_m_per_s = std::sqrt(dot(velocity_m_per_s, velocity_m_per_s));
  return speed_m_per_s > 0.01f ? (force_N / speed_m_per_s) * velocity_m_per_s : Vector3{};
}

}  // namespace inkwell::tests
