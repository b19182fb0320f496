#include <doctest/doctest.h>

#include <control/settings.hpp>
#include <firmware/control/arms.hpp>
#include <protocol/reports.hpp>

using namespace inkwell;
using control::MotorHeat;
using control::Triple;

namespace {

constexpr float continuous_A = 1.24f;

control::HeatScale scale(float time_constant_s) {
  protocol::ParameterSet set = tests::omni_parameters();
  set[protocol::Parameter::continuous_current_1_A] = continuous_A;
  set[protocol::Parameter::winding_time_constant_s] = time_constant_s;
  return control::prepare(set).heat;
}

void run(MotorHeat& motors, const Triple& current_A, const control::HeatScale& scale, float time_s) {
  const auto periods = static_cast<int>(time_s * protocol::servo_rate_Hz);
  for (int period = 0; period < periods; ++period) {
    const auto motor = static_cast<std::size_t>(period % 3);
    control::update_heat(motors, motor, current_A[motor], scale);
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

TEST_CASE("heat goes with the square of the current, and away without one") {
  MotorHeat motors;
  run(motors, {2.0f * continuous_A, 0.0f, 0.0f}, scale(0.1f), 1.0f);
  CHECK(motors.heat[0] == doctest::Approx(4.0f).epsilon(0.001));
  run(motors, {}, scale(0.1f), 1.0f);
  CHECK(motors.heat[0] < 0.001f);
}

TEST_CASE("a slow winding still warms by the little that one update adds") {
  MotorHeat motors;
  run(motors, {continuous_A, 0.0f, 0.0f}, scale(1000.0f), 1.0f);
  CHECK(motors.heat[0] == doctest::Approx(0.001f).epsilon(0.01));
  motors.heat[0] = 0.99f;
  run(motors, {continuous_A, 0.0f, 0.0f}, scale(1000.0f), 5.0f);
  CHECK(motors.heat[0] == doctest::Approx(0.99f + 0.01f * 0.005f).epsilon(5e-6));
}

}  // namespace
