#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/settings.hpp"
#include "protocol/reports.hpp"
#include "tests/firmware/control/arms.hpp"

using namespace inkwell;
using control::MotorHeat;
using control::Triple;

namespace {

constexpr float continuous_A = 1.24f;

using protocol::Parameter;

/// Returns a motor model without a housing: all heat is in the winding.
protocol::ParameterSet winding_only(float time_constant_s) {
  protocol::ParameterSet set = tests::omni_parameters();
  set[Parameter::continuous_current_1_A] = continuous_A;
  set[Parameter::winding_time_constant_s] = time_constant_s;
  set[Parameter::winding_heat_part] = 1.0f;
  return set;
}
control::HeatScale scale(float time_constant_s) { return control::prepare(winding_only(time_constant_s)).heat; }

void run(MotorHeat& motors, const Triple& current_A, const control::HeatScale& scale, float time_s) {
  const auto periods = static_cast<int>(time_s * protocol::servo_rate_Hz) / 3 * 3;  // complete rounds of the three
                                                                                    // motors
  for (int period = 0; period < periods; ++period) {
    const auto motor = static_cast<std::size_t>(period % 3);
    motors.update(motor, current_A[motor], scale);
  }
}

TEST_CASE("the continuous current leads to a heat of one, 63 % of it in one time constant") {
  MotorHeat motors;
  run(motors, {-continuous_A, 0.0f, 0.0f}, scale(0.5f), 0.5f);
  CHECK(motors.heat[0] == doctest::Approx(0.632f).epsilon(0.02));
  CHECK(motors.heat[1] == 0.0f);
  run(motors, {continuous_A, 0.0f, 0.0f}, scale(0.5f), 3.0f);
  CHECK(motors.heat[0] == doctest::Approx(1.0f).epsilon(0.003));
}

TEST_CASE("the heat follows the square of the current, and falls without a current") {
  MotorHeat motors;
  run(motors, {2.0f * continuous_A, 0.0f, 0.0f}, scale(0.1f), 1.0f);
  CHECK(motors.heat[0] == doctest::Approx(4.0f).epsilon(0.001));
  run(motors, {}, scale(0.1f), 1.0f);
  CHECK(motors.heat[0] < 0.001f);
}

TEST_CASE("a slow winding still warms by the little that one update adds") {
  MotorHeat motors;
  run(motors, {continuous_A, 0.0f, 0.0f}, scale(1000.0f), 1.0f);
  CHECK(motors.heat[0] == doctest::Approx(0.001f).scale(0).epsilon(0.01));
  motors.heat[0] = 0.99f;
  run(motors, {continuous_A, 0.0f, 0.0f}, scale(1000.0f), 5.0f);
  CHECK(motors.heat[0] == doctest::Approx(0.99f + 0.01f * 0.005f).epsilon(5e-6));
}

TEST_CASE("the winding warms quickly over its housing, the housing slowly over the room") {
  protocol::ParameterSet set = winding_only(0.05f);
  set[Parameter::housing_time_constant_s] = 2.0f;
  set[Parameter::winding_heat_part] = 0.2f;
  const control::HeatScale both = control::prepare(set).heat;
  MotorHeat motors;
  run(motors, {2.0f * continuous_A, 0.0f, 0.0f}, both, 0.5f);
  // Twice the current produces four times the heat. The winding contributes 20 % of the heat immediately, and the
  // housing contributes 80 % slowly.
  const float housing = 4.0f * 0.8f * (1.0f - std::exp(-0.5f / 2.0f));
  CHECK(motors.heat[0] == doctest::Approx(4.0f * 0.2f + housing).scale(0).epsilon(0.02));
  run(motors, {}, both, 0.5f);
  CHECK(motors.heat[0] == doctest::Approx(housing * std::exp(-0.5f / 2.0f)).scale(0).epsilon(0.02));
}

TEST_CASE("a hot motor may carry less: its limit when cool, its continuous current at a heat of one") {
  protocol::ParameterSet set = winding_only(0.1f);
  const float limit_A = set[Parameter::current_limit_1_A] = 2.5f;
  const control::HeatScale quick = control::prepare(set).heat;
  const control::Motors limits = control::prepare(set).motors;
  MotorHeat motors;
  run(motors, {0.9f * continuous_A, 0.0f, 0.0f}, quick, 1.0f);
  CHECK(motors.heat[0] == doctest::Approx(0.81f).epsilon(0.001));
  CHECK(limits.allowed_A(0, motors.beyond) == limit_A);
  run(motors, {continuous_A, 0.0f, 0.0f}, quick, 1.0f);
  CHECK(limits.allowed_A(0, motors.beyond) == doctest::Approx(continuous_A).scale(0).epsilon(0.01));
  CHECK(limits.allowed_A(0, {0.5f, 0.0f, 0.0f}) == 0.0f);
  set[Parameter::current_limit_1_A] = 0.9f * continuous_A;
  CHECK(control::prepare(set).motors.allowed_A(0, motors.beyond) == 0.9f * continuous_A);

  // The requested current equals the current limit. The motor receives the allowed current, and the heat settles just
  // below the heat limit.
  set[Parameter::winding_time_constant_s] = 1.0f;
  const control::HeatScale slower = control::prepare(set).heat;
  motors = {};
  float hottest = 0.0f;
  for (int update = 0; update < 500; ++update) {
    run(motors, {limits.allowed_A(0, motors.beyond), 0.0f, 0.0f}, slower, 0.0192f);
    hottest = std::max(hottest, motors.heat[0]);
  }
  CHECK(motors.heat[0] > 0.95f);
  CHECK(hottest < 1.1f);
}

TEST_CASE("a motor that overheats despite its limit is reported as too hot until it has cooled") {
  const control::HeatScale quick = scale(0.1f);
  MotorHeat motors;
  run(motors, {0.0f, 0.0f, 1.1f * continuous_A}, quick, 1.0f);
  CHECK(!motors.too_hot);
  run(motors, {0.0f, 0.0f, 1.2f * continuous_A}, quick, 1.0f);
  CHECK(motors.too_hot);
  run(motors, {0.0f, 0.0f, 0.95f * continuous_A}, quick, 1.0f);
  CHECK(motors.heat[2] < 1.0f);
  CHECK(motors.too_hot);
  run(motors, {}, quick, 0.1f);
  CHECK(!motors.too_hot);
}

}  // namespace
