// Tests the allowed change of a motor current per control period, and the detection of a larger change.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "firmware/control/supervision/current_jump.hpp"

#include "tests/firmware/control/near_wall.hpp"
#include "tests/firmware/control/simulated_arm.hpp"
#include "tests/firmware/control/simulated_motors.hpp"

namespace {

using namespace inkwell;
using control::CurrentJump;
using control::Triple;
using protocol::Fault;
using protocol::Parameter;

struct HeldArm {
  protocol::ParameterSet parameters = tests::pressed_into_three_walls({0.002f, 0.001f, 0.002f}, 2000.0f);
  control::Settings settings = control::prepare(parameters);
  control::Controller controller = tests::active_controller(settings);
  control::Samples samples = tests::samples_at_rest();
  tests::SimulatedMotors motors;
  control::Drive drive;
  float largest_change_A = 0.0f;  ///< of a reading per period

  void set(Parameter parameter, float value) {
    parameters[parameter] = value;
    settings = control::prepare(parameters);
    controller.settings_changed();
  }

  /// Runs at most `periods`, and returns the number of periods until the bridges are off.
  int run(int periods) {
    for (int period = 0; period < periods; ++period) {
      Triple voltage_V{};
      for (std::size_t i = 0; i < 3; ++i) voltage_V[i] = drive.duty[i] * samples.supply_V;
      const Triple before_A = samples.current_A;
      samples.current_A = motors.step(voltage_V);
      for (std::size_t i = 0; i < 3; ++i)
        largest_change_A = std::max(largest_change_A, std::fabs(samples.current_A[i] - before_A[i]));
      controller.host_alive();
      drive = tests::run(controller, samples, settings, 1);
      if (!drive.enabled && period > 0) return period;
    }
    return periods;
  }

  /// Adjusts the wall stiffness until the current reading of this motor is `current_A`.
  void press(std::size_t motor, float current_A) {
    for (int i = 0; i < 10; ++i) {
      REQUIRE(run(3'000) == 3'000);
      const float now_A = std::fabs(samples.current_A[motor]);
      if (std::fabs(now_A - current_A) < 0.01f) return;
      set(Parameter::wall_stiffness_N_per_m, parameters[Parameter::wall_stiffness_N_per_m] * current_A / now_A);
    }
    FAIL("the motor does not come to that current");
  }
};

TEST_CASE("a current change is a jump only beyond the tolerance plus the loop error or the back-EMF current") {
  const auto resistance = control::Resistance::of(2.0f, 0.0f, 2.0f);
  constexpr float tolerance_A = CurrentJump::tolerance_A;
  for (const float sign : {1.0f, -1.0f}) {
    CHECK_FALSE(is_jump(sign * (tolerance_A - 0.01f), 0.0f, 0.0f, resistance));
    CHECK(is_jump(sign * (tolerance_A + 0.01f), 0.0f, 0.0f, resistance));
    for (const float other_sign : {1.0f, -1.0f}) {
      CHECK_FALSE(is_jump(sign * (tolerance_A + 0.99f), other_sign * 1.0f, 0.0f, resistance));
      CHECK(is_jump(sign * (tolerance_A + 1.01f), other_sign * 1.0f, 0.0f, resistance));
      CHECK_FALSE(is_jump(sign * (tolerance_A + 0.49f), 0.0f, other_sign * 1.0f, resistance));
      CHECK(is_jump(sign * (tolerance_A + 0.51f), 0.0f, other_sign * 1.0f, resistance));
    }
  }
}

TEST_CASE("each motor's change is looked at") {
  constexpr float tolerance_A = CurrentJump::tolerance_A;
  CHECK_FALSE(control::is_large(0.5f * tolerance_A, -0.5f * tolerance_A, 0.5f * tolerance_A));
  for (const float size_A : {-1.01f * tolerance_A, 1.01f * tolerance_A}) {
    CHECK(control::is_large(size_A, 0.0f, 0.0f));
    CHECK(control::is_large(0.0f, size_A, 0.0f));
    CHECK(control::is_large(0.0f, 0.0f, size_A));
  }
}

TEST_CASE("an open motor switches the force off in the period of its first reading, and the arm stays referenced") {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    HeldArm arm;
    arm.press(motor, 0.5f);
    arm.motors.motors[motor].is_open = true;
    arm.motors.motors[motor].current_A = 0.0f;
    CHECK(arm.run(2) == 1);
    CHECK_FALSE(arm.drive.enabled);
    CHECK(arm.controller.fault() == Fault::current_jump);
    CHECK(arm.controller.is_referenced());
  }
}

TEST_CASE("a current sensor whose gain halves or doubles at 0.7 A raises current_jump in the first period") {
  for (const std::size_t motor : {std::size_t{0}, std::size_t{2}})  // the current of the second motor is lower here
    for (const float gain : {0.5f, 2.0f}) {
      CAPTURE(motor);
      CAPTURE(gain);
      HeldArm arm;
      arm.press(motor, 0.7f);
      arm.motors.motors[motor].sensor_gain = gain;
      CHECK(arm.run(2) == 1);
      CHECK(arm.controller.fault() == Fault::current_jump);
    }
}

TEST_CASE("a small current that ends is left to the motor check") {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    HeldArm arm;
    arm.press(motor, 0.25f);
    arm.motors.motors[motor].is_open = true;
    arm.motors.motors[motor].current_A = 0.0f;
    const int periods = arm.run(4'000);
    CHECK(periods > 10);
    CHECK(periods < 200);
    CHECK(arm.controller.fault() == Fault::motor_implausible);
  }
}

TEST_CASE(
    "a force that changes as fast as its default lets it changes a current by less than a third of the bearable") {
  HeldArm arm;
  arm.press(0, 1.0f);
  arm.largest_change_A = 0.0f;
  arm.samples.encoder_counts[0] += 12;  // out of the wall
  CHECK(arm.run(1'000) == 1'000);
  CHECK(arm.largest_change_A > 0.02f);
  CHECK(arm.largest_change_A < 0.33f * CurrentJump::tolerance_A);
}

TEST_CASE("healthy motors raise no fault when current limits and forces jump") {
  HeldArm arm;
  arm.set(Parameter::force_change_N_per_s, 100'000.0f);
  arm.set(Parameter::force_ramp_s, 0.0f);
  arm.press(0, 1.0f);
  arm.largest_change_A = 0.0f;
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    for (const Parameter limit :
         {Parameter::current_limit_1_A, Parameter::current_limit_2_A, Parameter::current_limit_3_A})
      arm.set(limit, i % 2 == 0 ? 0.1f : 2.5f);
    REQUIRE(arm.run(60) == 60);
    arm.set(Parameter::force_limit_N, i % 2 == 0 ? 0.0f : 8.0f);
    REQUIRE(arm.run(60) == 60);
    arm.samples.encoder_counts[0] += i % 4 < 2 ? 10 : -10;
    REQUIRE(arm.run(60) == 60);
  }
  CHECK(arm.largest_change_A > 0.5f * CurrentJump::tolerance_A);  // a large change was tested
}

TEST_CASE("current changes end neither a brake nor a force that is requested during a test pulse") {
  HeldArm arm;
  arm.press(0, 1.0f);
  // Above the speed limit the arm is braked. The current differs between successive readings.
  int braked = 0;
  for (int i = 0; i < 200; ++i) {
    arm.samples.encoder_counts[1] += 8;
    if (arm.controller.state() == protocol::State::fault)
      arm.samples.current_A = {i % 2 == 0 ? 1.0f : 0.2f, 0.0f, 0.0f};
    arm.controller.host_alive();
    braked += tests::run(arm.controller, arm.samples, arm.settings, 1).brake;
  }
  CHECK(arm.controller.fault() == Fault::over_speed);
  CHECK(braked > 100);

  HeldArm tested;
  tested.controller = tests::ready_controller(tested.settings);
  auto pulse = tests::command(protocol::Command::test_current);
  pulse.test = {1, 1.0f, 0.05f};
  tested.controller.carry_out(pulse);
  tested.run(100);
  REQUIRE(std::fabs(tested.samples.current_A[0]) > 0.5f);
  tested.controller.carry_out(tests::command(protocol::Command::enable_force));
  tests::run(tested.controller, tested.samples, tested.settings, 1);
  tested.samples.current_A = {};
  for (auto& each : tested.motors.motors) each.current_A = 0.0f;
  tests::run(tested.controller, tested.samples, tested.settings, 2);
  CHECK(tested.controller.fault() == Fault::none);
  CHECK(tested.controller.force_is_on());
}

TEST_CASE("a motor that turns when the force switches on immediately has a current from its back EMF") {
  for (std::size_t motor = 0; motor < 3; ++motor)
    for (const bool is_turning : {true, false}) {
      CAPTURE(motor);
      CAPTURE(is_turning);
      HeldArm arm;
      arm.set(Parameter::speed_limit_m_per_s, 10.0f);
      for (auto& each : arm.motors.motors) each.inductance_H = 0.2e-3f;
      REQUIRE(arm.run(4'000) == 4'000);
      constexpr std::int32_t counts_per_period = 2;
      const float speed_rad_per_s =
          static_cast<float>(counts_per_period) * arm.settings.encoders.rad_per_count[motor] / protocol::servo_period_s;
      const float back_emf_V = arm.settings.motor_model.back_emf_Vs_per_rad[motor] * speed_rad_per_s;
      REQUIRE(std::fabs(back_emf_V) > 2.5f);
      const auto turn = [&](int periods) {
        for (int i = 0; i < periods; ++i) {
          if (is_turning) arm.samples.encoder_counts[motor] += counts_per_period;
          arm.run(1);
          if (arm.drive.enabled) continue;
          for (auto& each : arm.motors.motors) each.current_A = 0.0f;  // no current while the bridges are off
        }
      };
      arm.controller.carry_out(tests::command(protocol::Command::stop));
      turn(100);
      REQUIRE(arm.controller.state() == protocol::State::ready);
      arm.motors.motors[motor].back_emf_V = back_emf_V;
      arm.controller.carry_out(tests::command(protocol::Command::enable_force));
      turn(10);
      CHECK(arm.controller.fault() == (is_turning ? Fault::none : Fault::current_jump));
    }
}

}  // namespace
