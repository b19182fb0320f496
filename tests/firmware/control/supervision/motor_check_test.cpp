// Tests how far a motor voltage may deviate from R i + k w, and the check of all three motors.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/near_wall.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::BridgeLoss;
using control::MotorCheck;
using control::MotorModel;
using control::Resistance;
using control::Triple;
using protocol::Fault;

constexpr MotorModel model{{2.0f, 4.0f, 8.0f}, {0.3f, -0.2f, 0.1f}};
constexpr int never = 100'000;

/// Returns the resistance from the parameters.
Resistance unmeasured(std::size_t motor) { return Resistance::of(0.0f, 0.0f, model.resistance_ohm[motor]); }

std::array<Resistance, 3> all(const Resistance& resistance) { return {resistance, resistance, resistance}; }
const std::array<Resistance, 3> all_unmeasured{unmeasured(0), unmeasured(1), unmeasured(2)};

/// Checks one motor with constant values. Returns the number of checks until a mismatch is reported.
int checks_until_fault(std::size_t motor, float voltage_V, float current_A, float joint_speed_rad_per_s,
                       BridgeLoss loss, const Resistance& resistance) {
  MotorCheck motor_check;
  Triple currents_A{}, speeds_rad_per_s{};
  currents_A[motor] = current_A;
  speeds_rad_per_s[motor] = joint_speed_rad_per_s;
  for (int check = 1; check < never; ++check) {
    motor_check.turn_to(motor, voltage_V, loss);
    if (!motor_check.update(currents_A, speeds_rad_per_s, all(resistance), model.back_emf_Vs_per_rad)) return check;
  }
  return never;
}
int checks_until_fault(std::size_t motor, float voltage_V, float current_A, float joint_speed_rad_per_s,
                       BridgeLoss loss = {}) {
  return checks_until_fault(motor, voltage_V, current_A, joint_speed_rad_per_s, loss, unmeasured(motor));
}

TEST_CASE("a motor with the voltage of its resistance and its speed fits, in either direction") {
  CHECK(checks_until_fault(0, 5.0f, 2.5f, 0.0f) == never);
  CHECK(checks_until_fault(0, -5.0f, -2.5f, 0.0f) == never);
  CHECK(checks_until_fault(1, 10.0f, 2.5f, 0.0f) == never);
  CHECK(checks_until_fault(0, 6.0f, 0.0f, 20.0f) == never);
  CHECK(checks_until_fault(1, -4.0f, 0.0f, 20.0f) == never);
  CHECK(checks_until_fault(2, 0.0f, -0.25f, 20.0f) == never);  // shorted and turned by a hand
}

TEST_CASE("a stationary motor without current tolerates tolerance_V plus the dead-time voltage, and no more") {
  CHECK(checks_until_fault(0, 0.99f * MotorCheck::tolerance_V, 0.0f, 0.0f) == never);
  CHECK(checks_until_fault(0, -0.99f * MotorCheck::tolerance_V, 0.0f, 0.0f) == never);
  CHECK(checks_until_fault(0, 1.1f * MotorCheck::tolerance_V, 0.0f, 0.0f) < never);
  CHECK(checks_until_fault(2, -1.1f * MotorCheck::tolerance_V, 0.0f, 0.0f) < never);
  for (const float dead_V : {0.1f, 0.5f}) {
    CHECK(checks_until_fault(0, 0.99f * (MotorCheck::tolerance_V + dead_V), 0.0f, 0.0f, {0.0f, dead_V}) == never);
    CHECK(checks_until_fault(0, 1.1f * (MotorCheck::tolerance_V + dead_V), 0.0f, 0.0f, {0.0f, dead_V}) < never);
  }
}

TEST_CASE("the lower voltage bound includes the smallest bridge loss if the current keeps its sign") {
  constexpr BridgeLoss loss{0.4f, 0.5f};
  for (const float sign : {1.0f, -1.0f}) {
    // R i is 2 V, and R may be up to 28 % too high.
    for (const float bridge_V : {0.4f, 0.5f})
      CHECK(checks_until_fault(0, sign * (2.0f + bridge_V), sign * 1.0f, 0.0f, loss) == never);
    const float least_V = 2.0f + 0.4f - MotorCheck::tolerance_V - 0.56f;
    CHECK(checks_until_fault(0, sign * (least_V + 0.02f), sign * 1.0f, 0.0f, loss) == never);
    CHECK(checks_until_fault(0, sign * (least_V - 0.02f), sign * 1.0f, 0.0f, loss) < never);
    const float most_V = 2.0f + 0.5f + MotorCheck::tolerance_V + 0.86f;
    CHECK(checks_until_fault(0, sign * (most_V - 0.02f), sign * 1.0f, 0.0f, loss) == never);
    CHECK(checks_until_fault(0, sign * (most_V + 0.02f), sign * 1.0f, 0.0f, loss) < never);
    // The lower bound ignores the voltage drop of the brushes, which is not reliable.
    CHECK(checks_until_fault(0, sign * (2.0f + 0.5f - MotorCheck::tolerance_V - 0.56f + 0.02f), sign * 1.0f, 0.0f,
                             {0.9f, 0.5f}) == never);
    // If a small current changes its sign within a PWM period, the dead time has no net effect.
    const float steady_A = MotorCheck::steady_A;
    const float small_V = -0.5f - MotorCheck::tolerance_V + 0.72f * 2.0f * steady_A + 0.02f;
    CHECK(checks_until_fault(0, sign * small_V, sign * 0.99f * steady_A, 0.0f, loss) == never);
    CHECK(checks_until_fault(0, sign * small_V, sign * 1.01f * steady_A, 0.0f, loss) < never);
  }
}

TEST_CASE(
    "a hot motor fits, and one that was hot when it was measured: 43 % more resistance, 28 % less, back EMF a quarter "
    "less") {
  for (const float sign : {1.0f, -1.0f}) {
    CHECK(checks_until_fault(0, sign * (1.42f * 5.0f + MotorCheck::tolerance_V), sign * 2.5f, 0.0f) == never);
    CHECK(checks_until_fault(0, sign * (1.5f * 5.0f + MotorCheck::tolerance_V), sign * 2.5f, 0.0f) < never);
    CHECK(checks_until_fault(0, sign * (0.73f * 5.0f - MotorCheck::tolerance_V), sign * 2.5f, 0.0f) == never);
    CHECK(checks_until_fault(0, sign * (0.7f * 5.0f - MotorCheck::tolerance_V), sign * 2.5f, 0.0f) < never);
    CHECK(checks_until_fault(0, sign * (0.76f * 6.0f - MotorCheck::tolerance_V), 0.0f, sign * 20.0f) == never);
    CHECK(checks_until_fault(0, sign * (0.65f * 6.0f - MotorCheck::tolerance_V), 0.0f, sign * 20.0f) < never);
  }
}

TEST_CASE("the resistance of a measured motor may be 20 % higher, plus the warming since the measurement") {
  for (const float sign : {1.0f, -1.0f}) {
    const auto fits_with = [sign](const Resistance& resistance, float voltage_V) {
      return checks_until_fault(0, sign * voltage_V, sign * 2.5f, 0.0f, {}, resistance) == never;
    };
    // A measured resistance of 2.5 ohm replaces the resistance from the parameters.
    const auto as_measured = Resistance::of(2.5f, 0.0f, 2.0f);
    CHECK(fits_with(as_measured, 1.19f * 6.25f + MotorCheck::tolerance_V));
    CHECK_FALSE(fits_with(as_measured, 1.21f * 6.25f + MotorCheck::tolerance_V));
    CHECK(fits_with(as_measured, 0.73f * 6.25f - MotorCheck::tolerance_V));
    CHECK_FALSE(fits_with(as_measured, 0.71f * 6.25f - MotorCheck::tolerance_V));
    // Heating at the continuous current increases the resistance by 39 %.
    const auto warmer = Resistance::of(2.5f, 1.0f, 2.0f);
    CHECK(warmer.value_ohm == doctest::Approx(1.39 * 2.5));
    CHECK(fits_with(warmer, 1.19f * 1.39f * 6.25f + MotorCheck::tolerance_V));
    CHECK_FALSE(fits_with(warmer, 1.21f * 1.39f * 6.25f + MotorCheck::tolerance_V));
    // Negative heat does not reduce the resistance.
    CHECK(Resistance::of(2.5f, -1.0f, 2.0f).value_ohm == 2.5f);
  }
}

TEST_CASE("the motor check sums the excess voltage, so that a larger excess raises a fault sooner") {
  // The voltage exceeds the tolerance by 4 V, and the check runs every three periods.
  const float voltage_V = 4.0f + MotorCheck::tolerance_V;
  const float flux_of_check_Vs = 4.0f * 3.0f * protocol::servo_period_s;
  CHECK(checks_until_fault(0, voltage_V, 0.0f, 0.0f) ==
        static_cast<int>(MotorCheck::tolerance_flux_Vs / flux_of_check_Vs) + 1);
  CHECK(checks_until_fault(0, 16.0f, 0.0f, 0.0f) == 2);
}

TEST_CASE("repeated sudden current reversals between both limits never raise a fault") {
  MotorCheck motor_check;
  const Triple still{};
  const auto check = [&](float voltage_V, float current_A) {
    motor_check.turn_to(0, voltage_V, {0.43f, 0.43f});
    return motor_check.update({current_A, 0.0f, 0.0f}, still, all_unmeasured, model.back_emf_Vs_per_rad);
  };
  for (int turn = 0; turn < 1'000; ++turn) {
    const float sign = turn % 2 == 0 ? 1.0f : -1.0f;
    CHECK(check(16.0f * sign, -1.0f * sign));  // 16 V change the current of 0.24 mH by more than this in one period
    for (int rest = 0; rest < 15; ++rest) CHECK(check(5.43f * sign, 2.5f * sign));
  }
}

TEST_CASE("each motor has its own sum") {
  MotorCheck motor_check;
  for (int check = 0; check < 300; ++check) {
    const std::size_t motor = static_cast<std::size_t>(check % 3);
    motor_check.turn_to(motor, motor == 2 ? 6.0f : 0.0f, {});
    if (motor_check.update({}, {}, all_unmeasured, model.back_emf_Vs_per_rad)) continue;
    CHECK(motor == 2);
    CHECK(motor_check.beyond_V[0] == 0.0f);
    CHECK(motor_check.beyond_V[1] == 0.0f);
    return;
  }
  FAIL("motor 3 was not noticed");
}

TEST_CASE("the model of each arm: its resistances, and the torque constants with gear and direction") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[motor_resistance_2_ohm] = 7.0f;
  set[motor_2_reversed] = 1.0f;
  set[torque_constant_2_Nm_per_A] = 0.02f;
  const auto settings = control::prepare(set);
  CHECK(settings.motor_model.resistance_ohm == Triple{2.18f, 7.0f, 2.18f});
  CHECK(settings.motor_model.back_emf_Vs_per_rad[1] == doctest::Approx(-0.02f * set[gear_ratio_2]));
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(settings.motor_model.back_emf_Vs_per_rad[i] * settings.motors.ampere_per_Nm[i] == doctest::Approx(1.0));
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(settings.motors.ampere_per_N[i] ==
          doctest::Approx(std::max(set[link_2_m], set[link_3_m]) * std::fabs(settings.motors.ampere_per_Nm[i])));
}

/// Each motor of the pressed arm needs a different voltage. The reading of motor `lying` is frozen.
struct PressedArm {
  protocol::ParameterSet parameters = [] {
    using enum protocol::Parameter;
    protocol::ParameterSet set = tests::pressed_into_three_walls({0.001f, 0.001f, 0.002f}, 3000.0f);
    set[force_ramp_s] = 0.0f;
    set[speed_limit_m_per_s] = 10.0f;
    return set;
  }();
  control::Settings settings = control::prepare(parameters);
  control::Controller controller = tests::active_controller(settings);
  control::Samples samples = tests::samples_at_rest();
  control::Drive drive, next;  // a duty cycle becomes active one period after its samples
  Triple speed_rad_per_s{};
  float back_emf_share = 1.0f;  // actual back-EMF relative to its value at the measured speed

  /// Runs at most `periods`, and returns the number of periods until the bridges are off. The winding currents settle
  /// within one period.
  int run(int periods, std::size_t lying = 3, Triple joint_counts_per_period = {}) {
    for (int period = 0; period < periods; ++period) {
      controller.host_alive();
      next = tests::run(controller, samples, settings, 1);
      if (!next.enabled && period > 0) {
        drive = next;
        return period;
      }
      for (std::size_t i = 0; i < 3; ++i) {
        samples.encoder_counts[i] += static_cast<std::int32_t>(joint_counts_per_period[i]);
        // The arm accelerates gradually.
        speed_rad_per_s[i] +=
            0.3f * (joint_counts_per_period[i] * settings.encoders.rad_per_count[i] / protocol::servo_period_s -
                    speed_rad_per_s[i]);
        const float back_emf_V = back_emf_share * settings.motor_model.back_emf_Vs_per_rad[i] * speed_rad_per_s[i];
        const float voltage_V = (drive.enabled ? drive.duty[i] * samples.supply_V : 0.0f) - back_emf_V;
        if (i != lying) samples.current_A[i] = 0.6f * samples.current_A[i] + 0.4f * voltage_V / 2.18f;
      }
      drive = next;
    }
    return periods;
  }
};

TEST_CASE("a frozen current reading of any motor switches the force off within milliseconds") {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    PressedArm arm;
    REQUIRE(arm.run(4'000) == 4'000);
    CHECK(std::fabs(arm.samples.current_A[motor]) > 0.02f);
    for (int i = 0; i < 20; ++i) {  // slow enough not to be detected as a jump
      arm.samples.current_A[motor] *= 0.966f;
      REQUIRE(arm.run(1, motor) == 1);
    }
    CHECK(arm.run(4'000, motor) < 200);
    CHECK(arm.controller.fault() == Fault::motor_implausible);
    CHECK_FALSE(arm.next.enabled);
    arm.controller.carry_out(tests::command(protocol::Command::clear_fault));
    arm.samples.current_A = {};
    arm.drive = {};
    tests::run(arm.controller, arm.samples, arm.settings, 2);
    CHECK(arm.controller.state() == protocol::State::unreferenced);
    arm.samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
    tests::run(arm.controller, arm.samples, arm.settings,
               control::SwitchFilter::settle_periods + control::InkwellReference::still_periods + 10);
    CHECK(arm.controller.state() == protocol::State::ready);
    // Clearing the fault also cleared the deviation sum, so a healthy motor raises no fault.
    arm.controller.carry_out(tests::command(protocol::Command::enable_force));
    arm.run(1);
    CHECK(arm.run(4'000) == 4'000);
  }
}

/// The self-test measured these motor resistances and a negligible voltage drop of the bridges.
const control::MeasuredMotors measured{{1e-4f, 1e-4f, 1e-4f}, {2.18f, 2.18f, 2.18f}, {}};

/// Returns the steady-state current at the motor's voltage without back-EMF.
float settled_A(const PressedArm& arm, std::size_t motor) {
  return arm.drive.duty[motor] * arm.samples.supply_V / 2.18f;
}
float reference_A(const PressedArm& arm, std::size_t motor) {
  return arm.controller.signals()[of_axis(protocol::Signal::current_reference_1_A, motor)];
}

TEST_CASE("at the force limit, a current sensor that reads too low raises the current by at most 5 %") {
  for (std::size_t motor = 0; motor < 3; ++motor)
    for (const bool is_measured : {true, false}) {
      CAPTURE(motor);
      CAPTURE(is_measured);
      PressedArm arm;
      arm.parameters[protocol::Parameter::force_limit_N] = 4.0f;
      arm.settings = control::prepare(arm.parameters);
      arm.controller = tests::active_controller(arm.settings, is_measured ? measured : control::MeasuredMotors{});
      REQUIRE(arm.run(4'000) == 4'000);
      REQUIRE(protocol::is_reached(arm.controller.limits(), protocol::Limit::force));
      // The current loops of healthy motors reach their references.
      for (std::size_t i = 0; i < 3; ++i)
        CHECK(settled_A(arm, i) == doctest::Approx(reference_A(arm, i)).scale(0).epsilon(0.01));
      arm.samples.current_A[motor] *= 0.98f;
      float most_part = 0.0f;
      for (int period = 0; period < 2'000 && arm.run(1, motor) == 1; ++period)
        most_part = std::max(most_part, settled_A(arm, motor) / reference_A(arm, motor));
      CHECK(most_part > 1.04f);
      CHECK((most_part < 1.06f) == is_measured);
    }
}

TEST_CASE("the values of a self-test apply even if the force is switched on three periods later") {
  for (const int idle_periods : {0, 100, 200, 300}) {  // the heat model is updated every 384 periods
    CAPTURE(idle_periods);
    PressedArm arm;
    arm.parameters[protocol::Parameter::force_limit_N] = 4.0f;
    arm.settings = control::prepare(arm.parameters);
    arm.controller = tests::ready_controller(arm.settings);
    tests::run(arm.controller, arm.samples, arm.settings, static_cast<std::uint32_t>(idle_periods));
    arm.controller.pass_self_test(measured);
    tests::run(arm.controller, arm.samples, arm.settings, 3);  // the motors are checked in turn
    arm.controller.carry_out(tests::command(protocol::Command::enable_force));
    REQUIRE(arm.run(60) == 60);
    arm.samples.current_A[0] *= 0.9f;
    arm.run(60, 0);
    CHECK(settled_A(arm, 0) / reference_A(arm, 0) == doctest::Approx(1.05).epsilon(0.01));
  }
}

TEST_CASE("below the force limit, a current sensor that reads too low adds at most the remaining force of the limit") {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    PressedArm arm;
    arm.controller = tests::active_controller(arm.settings, measured);
    REQUIRE(arm.run(4'000) == 4'000);
    const float left_N = 8.0f - arm.controller.signals()[protocol::Signal::force_N];
    REQUIRE(left_N > 0.3f);
    REQUIRE(left_N < 2.0f);
    const float requested_A = std::fabs(reference_A(arm, motor));
    const float more_A = left_N * arm.settings.motors.ampere_per_N[motor];
    arm.samples.current_A[motor] *= 0.98f;
    float most_A = 0.0f;
    for (int period = 0; period < 2'000 && arm.run(1, motor) == 1; ++period)
      most_A = std::max(most_A, std::fabs(settled_A(arm, motor)));
    CHECK(most_A < 1.01f * 1.05f * (requested_A + more_A));
    CHECK(most_A > requested_A + 0.6f * more_A);
  }
}

TEST_CASE("at the force limit the current of a motor that turns follows as well") {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    PressedArm arm;
    arm.parameters[protocol::Parameter::force_limit_N] = 4.0f;
    arm.settings = control::prepare(arm.parameters);
    arm.controller = tests::active_controller(arm.settings, measured);
    REQUIRE(arm.run(1'000) == 1'000);
    for (const float counts : {1.0f, 2.0f, 1.0f, 0.0f, -1.0f}) {
      Triple joint_counts_per_period{};
      joint_counts_per_period[motor] = counts;
      REQUIRE(arm.run(60, 3, joint_counts_per_period) == 60);
      REQUIRE(protocol::is_reached(arm.controller.limits(), protocol::Limit::force));
      CHECK(arm.samples.current_A[motor] == doctest::Approx(reference_A(arm, motor)).scale(0).epsilon(0.05));
    }
  }
}

TEST_CASE("the voltage of a motor that turns is plausible only with the back EMF of its speed") {
  for (std::size_t motor = 0; motor < 3; ++motor)
    for (const float back_emf_share : {1.0f, 0.0f}) {
      CAPTURE(motor);
      CAPTURE(back_emf_share);
      PressedArm arm;
      REQUIRE(arm.run(1'000) == 1'000);
      arm.back_emf_share = back_emf_share;
      int periods = 0;
      for (const float counts : {1.0f, 2.0f, 3.0f, 4.0f}) {
        Triple joint_counts_per_period{};
        joint_counts_per_period[motor] = -counts;
        periods += arm.run(60, 3, joint_counts_per_period);
      }
      CHECK((periods == 4 * 60) == (back_emf_share == 1.0f));
      CHECK((arm.controller.fault() == Fault::motor_implausible) == (back_emf_share == 0.0f));
    }
}

TEST_CASE("without force nothing is checked: the pulses that measure a motor find any resistance") {
  const auto settings = control::prepare(tests::omni_parameters());
  control::Controller controller = tests::ready_controller(settings);
  auto pulse = tests::command(protocol::Command::test_voltage);
  pulse.test = {1, 10.0f, 0.05f};
  controller.carry_out(pulse);
  CHECK(tests::run(controller, tests::samples_at_rest(), settings, 900).enabled);
  CHECK(controller.state() == protocol::State::ready);
}

}  // namespace
