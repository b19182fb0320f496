#include "boards/virtual/plant/plant.hpp"

#include <cmath>

#include <doctest/doctest.h>
#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/plant/driven_plant.hpp"

using namespace inkwell;
using namespace inkwell::test;

TEST_CASE("the motor force meter measures the force of the motor torques, averaged over a control period") {
  const Matrix3 jacobian_m = Vector3(0.1, 0.2, 0.05).asDiagonal();
  MotorForceMeter meter;
  meter.start();
  meter.step({0.3, 0.0, 0.0}, jacobian_m, true);
  meter.step({0.0, 0.8, 0.0}, jacobian_m, true);
  CHECK(meter.peak_N() == 0.0);  // no complete period yet
  meter.step({0.0, 0.0, 0.0}, jacobian_m, true);
  CHECK(meter.peak_N() == doctest::Approx(std::hypot(1.0, 4.0 / 3.0)));
  meter.step({0.0, 0.0, 0.0}, jacobian_m, true);
  CHECK(meter.peak_N() == doctest::Approx(std::hypot(1.0, 4.0 / 3.0)));
  meter.start();
  for (int step = 0; step < 3; ++step) meter.step({0.01, 0.0, 0.0}, jacobian_m, true);
  CHECK(meter.peak_N() == doctest::Approx(0.1));
  for (int step = 0; step < 3; ++step) meter.step({0.3, 0.0, 0.0}, jacobian_m, false);  // braked
  CHECK(meter.peak_N() == doctest::Approx(0.1));
  for (int step = 0; step < 3; ++step) meter.step({0.02, 0.0, 0.0}, jacobian_m, true);
  CHECK(meter.peak_N() == doctest::Approx(0.2));
  CHECK(meter.peak_over_ms_N() == 0.0);  // no complete millisecond yet
  for (int step = 0; step < 58; ++step) meter.step({0.0, 0.0, 0.0}, jacobian_m, true);
  CHECK(meter.peak_over_ms_N() == 0.0);
  meter.step({0.0, 0.0, 0.0}, jacobian_m, true);
  // The meter adds the magnitudes of three periods: one whole period and parts of two periods.
  CHECK(meter.peak_over_ms_N() == doctest::Approx(0.2 * (1.0 + 2.0 / 3 + 1.0 / 3) / 60));
  meter.start();
  for (int step = 0; step < 6; ++step) meter.step({0.0, step < 3 ? 0.04 : -0.04, 0.0}, jacobian_m, true);
  for (int step = 0; step < 2; ++step) meter.step({0.0, 0.0, 0.0}, jacobian_m, true);
  CHECK(meter.peak_over_ms_N() == doctest::Approx(0.2 * (4.0 + 2.0 / 3) / 60));  // a force that reverses is not lost
  const Matrix3 singular_m = Vector3(0.1, 0.2, 1e-4).asDiagonal();
  for (int step = 0; step < 3; ++step) meter.step({0.0, 0.0, 0.01}, singular_m, true);
  CHECK(meter.peak_N() == doctest::Approx(0.2));
}

TEST_CASE("the motor force meter of the plant measures the force of the motors with and without a hand") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  DrivenPlant driven(arm);
  driven.plant.place(free_joints(arm), Vector3::Zero());
  driven.plant.start_meters();
  const auto peak_N = [&] { return driven.plant.motor_force_meter().peak_N(); };
  driven.enable(true);
  driven.run(0.005, {0.1, -0.05, 0.0});
  const Truth t = driven.plant.truth(driven.now);
  const ArmDynamics dynamics(arm);
  const Vector3 now_N = dynamics.jacobian_m(t.joints_rad).transpose().inverse() * t.torque_Nm;
  CHECK(now_N.norm() > 0.1);
  CHECK(peak_N() > 0.9 * now_N.norm());
  CHECK(peak_N() < 1.5 * now_N.norm());
  // A braked arm in motion exerts a force.
  driven.legs(PinLevel::low);
  driven.idle(0.01);
  driven.plant.place(free_joints(arm), {6.0, 6.0, 6.0});
  driven.plant.start_meters();
  driven.idle(0.005);
  const Truth braked = driven.plant.truth(driven.now);
  CHECK((dynamics.jacobian_m(braked.joints_rad).transpose().inverse() * braked.torque_Nm).norm() > 0.1);
  CHECK(peak_N() == 0.0);
}
