// Tests the current loop with the arm's gains and with a motor model of resistance, inductance and back-EMF.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/signal_path/current_loop.hpp"
#include "firmware/control/signal_path/torque.hpp"
#include "protocol/reports.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::CurrentLoop;
using control::CurrentLoopGains;

constexpr double resistance_ohm = arm_defaults::motor_resistance_1_ohm;
constexpr double inductance_H = arm_defaults::motor::inductance_H;

struct Motor {
  double current_A = 0;

  /// Exact solution for a constant voltage.
  void run(double voltage_V, double time_s) {
    const double settled_A = voltage_V / resistance_ohm;
    current_A = settled_A + (current_A - settled_A) * std::exp(-time_s * resistance_ohm / inductance_H);
  }
};

struct RegulatedMotor {
  Motor motor;
  CurrentLoop loop;
  CurrentLoopGains gains = control::prepare(tests::omni_parameters()).current_loop;
  double next_V = 0;  ///< the controller's output becomes active one period later

  /// Runs one control period and returns the measured current.
  double step(double reference_A, double back_emf_V = 0, double bound_V = 16) {
    const double seen_A = motor.current_A;
    const control::CurrentLoopStep result =
        control::regulate(loop, static_cast<float>(reference_A), static_cast<float>(seen_A), gains,
                          {static_cast<float>(-bound_V), static_cast<float>(bound_V)});
    loop = result.loop;
    motor.run(next_V - back_emf_V, protocol::servo_period_s);
    next_V = static_cast<double>(result.voltage_V);
    return seen_A;
  }
};

TEST_CASE("a step of current: 63 % within 0.3 ms, overshoot under 10 %, no steady error") {
  for (const double step_A : {0.05, 1.0, -2.0}) {
    CAPTURE(step_A);
    RegulatedMotor regulated;
    int periods_to_63 = -1;
    double peak = 0, seen = 0;
    for (int period = 0; period < 400; ++period) {
      seen = regulated.step(step_A) / step_A;
      peak = std::max(peak, seen);
      if (periods_to_63 < 0 && seen >= 0.632) periods_to_63 = period;
    }
    MESSAGE("63 % after " << periods_to_63 * 0.05 << " ms, overshoot " << 100 * (peak - 1) << " %");
    REQUIRE(periods_to_63 > 0);
    CHECK(periods_to_63 * 50e-6 <= 0.3e-3);
    CHECK(peak < 1.1);
    CHECK(std::abs(seen - 1) < 1e-4);
  }
}

TEST_CASE("back EMF of a fast and of an accelerating hand is compensated") {
  RegulatedMotor regulated;
  for (int period = 0; period < 100; ++period) regulated.step(1.0);
  // 10 rad/s at the joint is 133 rad/s and 3.1 V at the motor.
  for (int period = 0; period < 100; ++period) regulated.step(1.0, 3.1);
  CHECK(regulated.motor.current_A == doctest::Approx(1.0).epsilon(1e-3));
  // The back-EMF changes linearly, so the steady-state error is slope / integral gain.
  double seen = 0;
  for (int period = 0; period < 2'000; ++period) seen = regulated.step(1.0, 3.1 - 12.4 * period / 20'000.0);
  CHECK(std::abs(seen - 1.0) < 0.002);
}

TEST_CASE("the voltage is bounded, and the integral does not wind up meanwhile") {
  RegulatedMotor regulated;
  for (int period = 0; period < 2'000; ++period) {
    regulated.step(10.0, 0, 4.0);
    CHECK(std::abs(regulated.next_V) <= 4.0);
  }
  CHECK(regulated.motor.current_A == doctest::Approx(4.0 / resistance_ohm).epsilon(1e-3));
  int periods = 0;
  while (std::abs(regulated.step(0.5, 0, 4.0) - 0.5) > 0.05 && periods < 1'000) ++periods;
  CHECK(periods <= 14);  // 0.7 ms; a wound-up integrator would need as long to unwind as to wind up
  double lowest = 1;
  for (int period = 0; period < 100; ++period) lowest = std::min(lowest, regulated.step(0.5, 0, 4.0));
  CHECK(lowest > 0.4);
}

TEST_CASE("each side of a voltage has its own bound") {
  const CurrentLoopGains gains = control::prepare(tests::omni_parameters()).current_loop;
  for (const float reference_A : {10.0f, -10.0f}) {
    CurrentLoop loop;
    for (int period = 0; period < 200; ++period) loop = regulate(loop, reference_A, 0.0f, gains, {-1.0f, 3.0f}).loop;
    CHECK(regulate(loop, reference_A, 0.0f, gains, {-1.0f, 3.0f}).voltage_V == (reference_A > 0.0f ? 3.0f : -1.0f));
    CHECK(std::fabs(loop.integral_V) < 1.0f);
  }
}

TEST_CASE(
    "the voltage range of a current loop includes the current in both directions, back EMF, bridge loss and motor "
    "tolerances") {
  const auto measured = control::Resistance::of(2.0f, 0.0f, 9.0f);
  const auto still = control::voltage_range(1.5f, measured, 0.0f, 0.4f, 16.0f);
  CHECK(still.most_V == doctest::Approx(1.05 * 3.0 + 0.4));
  CHECK(still.least_V == -still.most_V);
  const auto turning = control::voltage_range(1.5f, measured, -2.0f, 0.4f, 16.0f);
  // The torque constant has a tolerance of 25 %, so each bound allows a quarter of the back-EMF.
  CHECK(turning.most_V == doctest::Approx(still.most_V - 2.0f + 0.5f));
  CHECK(turning.least_V == doctest::Approx(still.least_V - 2.0f - 0.5f));
  // The resistance from the parameters has a larger tolerance than a measured resistance.
  CHECK(control::voltage_range(1.5f, control::Resistance::of(0.0f, 0.0f, 2.0f), 0.0f, 0.4f, 16.0f).most_V ==
        doctest::Approx(1.1075 * 3.0 + 0.4));
  for (const float back_emf_V : {-30.0f, 0.0f, 30.0f}) {
    const auto [least_V, most_V] = control::voltage_range(1.5f, measured, back_emf_V, 0.4f, 3.0f);
    // A wrong speed must not permit a voltage with the opposite sign of the current.
    CHECK(least_V == (back_emf_V > 0.0f ? 0.0f : -3.0f));
    CHECK(most_V == (back_emf_V < 0.0f ? 0.0f : 3.0f));
  }
}

TEST_CASE("a motor with 30 % less inductance or half more resistance stays stable") {
  for (const double scale : {0.7, 1.5}) {
    RegulatedMotor regulated;
    regulated.gains.proportional_V_per_A *= static_cast<float>(scale);
    regulated.gains.half_integral_V_per_A *= static_cast<float>(scale);
    double peak = 0;
    for (int period = 0; period < 200; ++period) peak = std::max(peak, regulated.step(1.0));
    CHECK(peak < 1.35);
    CHECK(regulated.motor.current_A == doctest::Approx(1.0).epsilon(1e-4));
  }
}

TEST_CASE("torque becomes current through gear and torque constant, with direction") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[gear_ratio_1] = 10.0f;
  set[torque_constant_1_Nm_per_A] = 0.02f;
  set[motor_2_reversed] = 1.0f;
  const control::Motors motors = control::prepare(set).motors;
  const auto [reference_A, by_current, by_heat] = control::current_references({0.2f, 0.1f, -0.1f}, motors, {});
  CHECK_FALSE(by_current);
  CHECK_FALSE(by_heat);
  CHECK(reference_A[0] == doctest::Approx(1.0f));
  CHECK(reference_A[1] == doctest::Approx(-0.1f / (set[gear_ratio_2] * set[torque_constant_2_Nm_per_A])));
  CHECK(reference_A[2] == doctest::Approx(-0.1f / (set[gear_ratio_3] * set[torque_constant_3_Nm_per_A])));
}

TEST_CASE("if one motor reaches its current limit, the currents of all motors are scaled down together") {
  control::Motors motors{{2.0f, -1.0f, 4.0f}, {1.0f, 2.0f, 0.5f}, {10.0f, 0.0f, 0.0f}};
  SUBCASE("one") {
    const auto [reference_A, by_current, by_heat] = control::current_references({1.0f, 0.5f, 0.1f}, motors, {});
    CHECK(by_current);
    CHECK_FALSE(by_heat);
    CHECK(reference_A[0] == doctest::Approx(1.0f));
    CHECK(reference_A[1] == doctest::Approx(-0.25f));
    CHECK(reference_A[2] == doctest::Approx(0.2f));
  }
  SUBCASE("two: the one that is further beyond") {
    const auto [reference_A, by_current, by_heat] = control::current_references({1.0f, 0.5f, -1.0f}, motors, {});
    CHECK(by_current);
    CHECK_FALSE(by_heat);
    CHECK(reference_A[0] == doctest::Approx(0.25f));
    CHECK(reference_A[1] == doctest::Approx(-0.0625f));
    CHECK(reference_A[2] == doctest::Approx(-0.5f));
  }
  SUBCASE("a hot motor: as if its limit were lower, down to nothing") {
    const auto [reference_A, by_current, by_heat] =
        control::current_references({0.5f, 0.5f, 0.1f}, motors, {0.05f, 0.0f, 0.0f});
    CHECK(by_heat);
    CHECK_FALSE(by_current);
    CHECK(reference_A[0] == doctest::Approx(0.5f));
    CHECK(reference_A[1] == doctest::Approx(-0.25f));
    CHECK(control::current_references({0.5f, 0.5f, 0.1f}, motors, {0.2f, 0.0f, 0.0f}).reference_A[1] == 0.0f);
    CHECK_FALSE(control::current_references({}, motors, {0.2f, 0.0f, 0.0f}).held_by_heat);
  }
  SUBCASE("a hot motor with a current limit below its continuous current reports the current limit") {
    const auto references = control::current_references({1.0f, 3.0f, 0.1f}, motors, {0.0f, 0.1f, 0.0f});
    CHECK(references.held_by_current);
    CHECK_FALSE(references.held_by_heat);
  }
  SUBCASE("a hot motor and a motor at its current limit report both limits") {
    const auto references = control::current_references({1.0f, 0.5f, 0.5f}, motors, {0.05f, 0.0f, 0.0f});
    CHECK(references.held_by_heat);
    CHECK(references.held_by_current);
  }
  SUBCASE("a motor whose limit is 0 takes no part") {
    motors.current_limit_A[2] = 0.0f;
    const auto [reference_A, by_current, by_heat] = control::current_references({0.5f, 0.5f, 9.0f}, motors, {});
    CHECK_FALSE(by_current);
    CHECK_FALSE(by_heat);
    CHECK(reference_A[0] == doctest::Approx(1.0f));
    CHECK(reference_A[1] == doctest::Approx(-0.5f));
    CHECK(reference_A[2] == 0.0f);
  }
}

}  // namespace
