// Tests the energy limit of the arm: integration, force reduction, and the maximum rate of change of the force.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/energy_reserve.hpp"

#include "tests/firmware/control/turning_arm.hpp"

namespace {

using namespace inkwell;
using control::EnergyReserve;
using control::Vector3;
using protocol::Limit;
using protocol::Parameter;
using protocol::Signal;
using tests::along;
using tests::TurningArm;

constexpr control::EnergyLimits limits{.reserve_J = 0.04f, .refill_J_per_period = 5e-5f, .low_reserves_per_J = 100.0f};

TEST_CASE("the energy reserve falls by the work of the force on the probe and rises by the work of the hand") {
  EnergyReserve reserve{0.02f, {0.1f, 0.0f, 0.0f}};
  reserve.update({2.0f, 1.0f, 0.0f}, {0.101f, 0.0f, 0.0f}, limits);
  CHECK(reserve.left_J == doctest::Approx(0.02f - 0.002f + 5e-5f));
  reserve.update({2.0f, 1.0f, 0.0f}, {0.101f, -0.004f, 0.0f}, limits);
  CHECK(reserve.left_J == doctest::Approx(0.018f + 0.004f + 1e-4f));
  for (int i = 0; i < 100; ++i) reserve.update({}, reserve.position_m, limits);
  CHECK(reserve.left_J == doctest::Approx(0.0221f + 100 * 5e-5f));

  reserve.update({-8.0f, 0.0f, 0.0f}, {0.2f, -0.004f, 0.0f}, limits);  // a hand that presses for a long time
  CHECK(reserve.left_J == limits.reserve_J);
  reserve.update({8.0f, 0.0f, 0.0f}, {0.3f, -0.004f, 0.0f}, limits);
  CHECK(reserve.left_J == 0.0f);
}

TEST_CASE(
    "the driving force component is reduced below a quarter of the energy reserve, and is zero with an empty reserve") {
  CHECK(EnergyReserve{0.04f, {}}.driving_reduction(limits) == 0.0f);
  CHECK(EnergyReserve{0.01f, {}}.driving_reduction(limits) == 0.0f);
  CHECK(EnergyReserve{0.005f, {}}.driving_reduction(limits) == doctest::Approx(0.5f));
  CHECK(EnergyReserve{0.0f, {}}.driving_reduction(limits) == 1.0f);

  const Vector3 force_N{2.0f, -1.0f, 0.5f}, velocity_m_per_s{0.4f, 0.0f, 0.3f};
  const float power_W = dot(force_N, velocity_m_per_s);
  CHECK(dot(without_drive(force_N, power_W, velocity_m_per_s, 0.5f), velocity_m_per_s) ==
        doctest::Approx(0.5f * power_W).scale(0).epsilon(2e-3));
  const Vector3 rest_N = without_drive(force_N, power_W, velocity_m_per_s, 1.0f);
  CHECK(dot(rest_N, velocity_m_per_s) < 2e-3f * power_W);
  CHECK(rest_N.y == force_N.y);  // the component across the motion does not change
  // Near zero speed the force does not depend on the direction, so it does not jump when the hand reverses.
  const Vector3 still_N = without_drive(force_N, 2e-6f, {1e-6f, 0.0f, 0.0f}, 1.0f);
  CHECK(still_N.x == doctest::Approx(force_N.x));
}

TEST_CASE("a program that pushes along with every motion gives the reserve and the power, and no more") {
  TurningArm arm;
  arm.set[Parameter::power_given_W] = 0.1f;
  arm.settings = control::prepare(arm.set);
  const auto pushes = [](const Vector3& velocity_m_per_s) { return along(velocity_m_per_s, 2.0f); };
  arm.turn(4.0f, pushes);
  MESSAGE("given in 4 s: ", arm.delivered_J, " J");
  CHECK(arm.delivered_J > 0.9f * (0.05f + 4.0f * 0.1f));  // the allowed energy
  CHECK(arm.delivered_J < 0.05f + 4.0f * 0.1f + 0.01f);  // an arm may exceed this energy slightly at low speed during a
                                                         // reversal
  CHECK(arm.reached(Limit::energy));

  TurningArm unbounded;
  unbounded.set[Parameter::power_given_W] = 20.0f;
  unbounded.settings = control::prepare(unbounded.set);
  unbounded.turn(4.0f, pushes);
  CHECK(unbounded.delivered_J > 0.8f);
  CHECK_FALSE(unbounded.reached(Limit::energy));
}

TEST_CASE("a program that brakes, and one that springs, lose nothing") {
  TurningArm arm;
  arm.set[Parameter::power_given_W] = 0.0f;
  arm.settings = control::prepare(arm.set);
  arm.turn(3.0f, [](const Vector3& velocity_m_per_s) { return along(velocity_m_per_s, -2.0f); });
  CHECK(arm.delivered_J < -0.5f);
  const Vector3 middle_m = arm.position();
  arm.turn(3.0f, [&](const Vector3&) { return 20.0f * (middle_m - arm.position()); });
  CHECK_FALSE(arm.reached(Limit::energy));
}

TEST_CASE("the force of any source changes by at most force_change_N_per_s") {
  TurningArm arm;
  arm.set[Parameter::force_change_N_per_s] = 2'000.0f;
  arm.settings = control::prepare(arm.set);
  float sign = 1.0f;
  const auto throws = [&](const Vector3&) { return Vector3{0.0f, (sign = -sign) * 3.0f, 0.0f}; };
  arm.turn(1.0f, throws);  // whole turns, because the encoder must not jump
  CHECK(arm.largest_change_N == doctest::Approx(0.1f).scale(0).epsilon(0.01));
  CHECK(arm.reached(Limit::change));

  // The force limit applies without delay.
  arm.turn(0.1f, [](const Vector3&) { return Vector3{0.0f, 3.0f, 0.0f}; });
  CHECK(arm.controller.signals()[Signal::force_N] > 2.5f);
  arm.set[Parameter::force_limit_N] = 1.0f;
  arm.settings = control::prepare(arm.set);
  arm.controller.settings_changed();
  tests::run(arm.controller, arm.samples, arm.settings, 1);
  CHECK(arm.controller.signals()[Signal::force_N] <= 1.001f);
}

}  // namespace
