// Tests the values that PoseReader adds to a pose.
#include <doctest/doctest.h>

#include <cmath>

#include "firmware/control/settings.hpp"
#include "protocol/parameters.hpp"

#include "host/bindings/library/pose_reader.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("the velocity is that of the way, and nothing where no way leads from one position to the next") {
  const control::Arm geometry = control::prepare(protocol::default_parameters()).arm;
  library::PoseReader reader;
  device::Pose report{};
  double x_m = 0.0;
  /// Advances by one millisecond at 0.1 m/s and returns the velocity along x.
  const auto next = [&](bool is_referenced) {
    report.time_periods += protocol::servo_rate_Hz / 1000;
    report.is_referenced = is_referenced;
    report.position_m[0] = static_cast<float>(x_m += 0.0001);
    return reader.read(report, geometry).velocity_m_s[0];
  };
  for (int i = 0; i < 5; ++i) CHECK(next(false) == 0.0);
  x_m += 0.05;  // position jump when the encoders are referenced
  CHECK(next(true) == 0.0);
  for (int i = 0; i < 20; ++i) CHECK(next(true) == doctest::Approx(0.1).epsilon(0.01));
  CHECK(next(false) == 0.0);
  x_m -= 0.02;
  CHECK(next(true) == 0.0);
  CHECK(next(true) == doctest::Approx(0.1).epsilon(0.01));
}

}  // namespace
}  // namespace inkwell::tests
