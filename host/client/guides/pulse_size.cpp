#include "host/client/guides/pulse_size.hpp"

#include <fmt/format.h>

#include "firmware/control/settings.hpp"
#include "firmware/control/signal_path/test_pulse.hpp"
#include "host/client/device/device.hpp"

namespace inkwell::guides {

float allowed_pulse_A(const protocol::ParameterSet& set, int motor) {
  // Margin for the arm's motion and for an inaccurate resistance.
  constexpr float part = 0.8f;
  constexpr float least_A = 0.2f;
  const control::Settings settings = control::prepare(set);
  const control::Jacobian jacobian = control::forward_kinematics(settings.encoders.inkwell_rad, settings.arm).jacobian;
  const auto index = static_cast<std::size_t>(motor - 1);
  const auto allowed_A = [&](float force_limit_N) {
    return part * control::test_limit_A(jacobian, index, force_limit_N, settings.motors.ampere_per_Nm[index]);
  };
  const float allowed = allowed_A(settings.force_limit_N);
  if (allowed < least_A)
    throw device::Error(
        fmt::format("force_limit_N is {:.2f} N and limits test pulses to {:.2f} A of motor {}, which is too small for "
                    "a measurement. Set force_limit_N to {:.1f} N or more, then start the guide again.",
                    settings.force_limit_N, allowed, motor, 0.1f + least_A / allowed_A(1.0f)));
  return allowed;
}

}  // namespace inkwell::guides
