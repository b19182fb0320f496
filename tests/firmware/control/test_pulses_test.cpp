// Tests the test pulses of one motor and the conditions that stop a pulse.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/controller_names.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::tests::controller_names;

protocol::CommandReport pulse(Command which, std::uint8_t motor, float amplitude, float duration_s) {
  protocol::CommandReport report = tests::command(which);
  report.test = {motor, amplitude, duration_s};
  return report;
}

/// Allowed current in the inkwell, calculated from force_limit_N. The motor alone produces a force along `normal`.
float test_limit_A(const Settings& settings, std::size_t motor) {
  const auto jacobian = control::forward_kinematics(settings.encoders.inkwell_rad, settings.arm).jacobian;
  const control::Vector3 normal = control::cross(jacobian.column[(motor + 1) % 3], jacobian.column[(motor + 2) % 3]);
  const float lever_m = control::dot(jacobian.column[motor], normal) / std::sqrt(control::dot(normal, normal));
  return std::fabs(settings.force_limit_N * lever_m * settings.motors.ampere_per_Nm[motor]);
}

TEST_CASE("a test pulse of current: its motor only, its time, its limit, then zero for as long") {
  const Settings settings = control::prepare(tests::paper_parameters());
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    Controller controller = tests::ready_controller(settings);
    controller.carry_out(pulse(Command::test_current, static_cast<std::uint8_t>(motor + 1), 99.0f, 0.01f));
    const auto check_references = [&](float expected_A) {
      CHECK(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
      constexpr protocol::EachAxis<Signal> references_A = Signal::current_reference_1_A;
      for (std::size_t i = 0; i < 3; ++i)
        CHECK(controller.signals()[references_A[i]] == doctest::Approx(i == motor ? expected_A : 0.0f));
    };
    for (int i = 0; i < 200; ++i) check_references(test_limit_A(settings, motor));
    for (int i = 0; i < 200; ++i) check_references(0.0f);
    CHECK_FALSE(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
    CHECK(controller.state() == State::ready);
  }
}

/// Returns the hand force that balances the torque of one motor, from J' F = torque by Cramer's rule.
double held_N(const control::Jacobian& jacobian, std::size_t motor, double torque_Nm) {
  const auto column = [&](std::size_t i) {
    const control::Vector3& v = jacobian.column[i % 3];
    return std::array<double, 3>{v.x, v.y, v.z};
  };
  const auto own = column(motor), p = column(motor + 1), q = column(motor + 2);
  const std::array<double, 3> across{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  const double determinant = own[0] * across[0] + own[1] * across[1] + own[2] * across[2];
  return std::fabs(torque_Nm / determinant) * std::hypot(across[0], across[1], across[2]);
}

TEST_CASE("the force of a current test pulse never exceeds force_limit_N, for every arm and pose") {
  constexpr double limit_N = 0.8;
  tests::Random random(7);
  for (const tests::Arm& arm : tests::all_arms()) {
    CAPTURE(arm.name);
    protocol::ParameterSet set = tests::without_motors(arm.parameters);
    set[protocol::Parameter::force_limit_N] = static_cast<float>(limit_N);
    const Settings settings = control::prepare(set);
    const Controller ready = tests::ready_controller(settings);
    double largest_N = 0.0;
    for (int pose = 0; pose < 10; ++pose) {
      Controller there = ready;
      Samples samples = tests::samples_at_rest();
      tests::move_to(there, samples, tests::counts_at(tests::random_joints(set, random), settings), settings);
      REQUIRE(there.state() == State::ready);
      const control::Triple joint_rad = control::joint_angles(samples.encoder_counts, settings.encoders);
      const control::Jacobian jacobian = control::forward_kinematics(joint_rad, settings.arm).jacobian;
      for (std::uint8_t motor = 1; motor <= 3; ++motor) {
        Controller controller = there;
        controller.carry_out(pulse(Command::test_current, motor, -99.0f, 0.01f));
        tests::run(controller, samples, settings, 1);
        const std::size_t i = motor - 1u;
        const float current_A = controller.signals()[of_axis(Signal::current_reference_1_A, i)];
        const double force_N = held_N(jacobian, i, static_cast<double>(current_A / settings.motors.ampere_per_Nm[i]));
        CHECK(force_N < limit_N * 1.001);
        largest_N = std::max(largest_N, force_N);
      }
    }
    CHECK(largest_N == doctest::Approx(limit_N).epsilon(1e-3));
  }
}

TEST_CASE("a voltage test pulse is limited where its current would exceed the force limit, for every resistance") {
  using arm_defaults::motor::inductance_H;
  for (const auto& [resistance_ohm, amplitude_V] : {std::pair(0.4f, 2.0f), {2.0f, 8.0f}, {40.0f, 8.0f}}) {
    CAPTURE(resistance_ohm);
    const Settings settings = control::prepare(tests::paper_parameters());
    Controller controller = tests::ready_controller(settings);
    Samples samples = tests::samples_at_rest();
    controller.carry_out(pulse(Command::test_voltage, 2, amplitude_V, 0.1f));
    const float limit_A = test_limit_A(settings, 1);
    REQUIRE(amplitude_V < settings.current_loop.voltage_limit_V);
    float current_A = 0.0f, largest_A = 0.0f, applied_V = 0.0f;
    for (int period = 0; period < 4'000; ++period) {
      samples.current_A[1] = current_A;
      controller.host_alive();
      const Drive drive = tests::run(controller, samples, settings, 1);
      const float settled_A = applied_V / resistance_ohm;
      current_A =
          settled_A + (current_A - settled_A) * std::exp(-protocol::servo_period_s * resistance_ohm / inductance_H);
      largest_A = std::max(largest_A, current_A);
      applied_V = drive.enabled ? drive.duty[1] * samples.supply_V : 0.0f;
    }
    CHECK(controller.state() == State::ready);
    // The current exceeds the limit for two periods: one for the measurement and one for the reaction.
    CHECK(largest_A < limit_A + 2.0f * amplitude_V * protocol::servo_period_s / inductance_H);
    CHECK(largest_A > 0.9f * std::min(limit_A, amplitude_V / resistance_ohm));
  }
}

TEST_CASE("while a test pulse runs another one is not begun, so that it lasts no longer than its time") {
  const Settings settings = control::prepare(tests::paper_parameters());
  Controller controller = tests::ready_controller(settings);
  controller.carry_out(pulse(Command::test_current, 2, 0.2f, 0.01f));
  for (int i = 0; i < 400; ++i) {
    CHECK(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
    controller.carry_out(pulse(Command::test_current, 3, 0.2f, 0.01f));
    CHECK(controller.signals()[Signal::current_reference_3_A] == 0.0f);
  }
}

TEST_CASE("a test pulse of current is the loop's: where the current is there it drives nothing") {
  const Settings settings = control::prepare(tests::paper_parameters());
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.current_A[1] = 0.2f;
  controller.carry_out(pulse(Command::test_current, 2, 0.2f, 0.01f));
  const Drive drive = tests::run(controller, samples, settings, 1);
  CHECK(drive.enabled);
  for (const float duty : drive.duty) CHECK(duty == doctest::Approx(0.0));
}

TEST_CASE("a voltage test pulse sets the duty cycle regardless of the current") {
  const Settings settings = control::prepare(tests::paper_parameters());
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.current_A[2] = -0.4f;
  controller.carry_out(pulse(Command::test_voltage, 3, -0.1f * board::supply_nominal_V, 0.005f));
  Drive drive = tests::run(controller, samples, settings, 100);
  CHECK(drive.duty[2] == doctest::Approx(-0.1f).epsilon(1e-4));
  CHECK(drive.duty[0] == 0.0f);
  CHECK(drive.duty[1] == 0.0f);
  CHECK(controller.signals()[Signal::current_reference_3_A] == 0.0f);
  drive = tests::run(controller, samples, settings, 100);
  CHECK(drive.enabled);
  CHECK(drive.duty[2] == 0.0f);
  controller.carry_out(pulse(Command::test_voltage, 1, 1000.0f, 0.005f));
  drive = tests::run(controller, samples, settings, 1);
  CHECK(drive.duty[0] ==
        doctest::Approx(settings.current_loop.voltage_limit_V / board::supply_nominal_V).epsilon(1e-4));
}

/// The current sensor saturates at 3.6 A.
float shown_A(float current_A) { return std::clamp(current_A, -3.6f, 3.6f); }

TEST_CASE("a current that its sensor cannot show trips within two control periods, at the largest limit too") {
  using arm_defaults::motor::inductance_H;
  constexpr float resistance_ohm = arm_defaults::motor_resistance_1_ohm;
  for (const float amplitude_V : {16.0f, -16.0f}) {
    CAPTURE(amplitude_V);
    protocol::ParameterSet set = tests::paper_parameters();
    set[protocol::Parameter::current_limit_1_A] = info(protocol::Parameter::current_limit_1_A).maximum;
    const Settings settings = control::prepare(set);
    Controller controller = tests::ready_controller(settings);
    Samples samples = tests::samples_at_rest();
    controller.carry_out(pulse(Command::test_voltage, 1, amplitude_V, 0.5f));
    float current_A = 0.0f, applied_V = 0.0f;
    int periods_beyond = 0;
    for (int period = 0; period < 1'000; ++period) {
      samples.current_A[0] = shown_A(current_A);
      const Drive drive = tests::run(controller, samples, settings, 1);
      if (controller.state() == State::fault) break;
      const float settled_A = applied_V / resistance_ohm;
      current_A =
          settled_A + (current_A - settled_A) * std::exp(-protocol::servo_period_s * resistance_ohm / inductance_H);
      if (std::abs(current_A) > tests::board_limits.current_measurable_A) ++periods_beyond;
      applied_V = drive.enabled ? drive.duty[0] * samples.supply_V : 0.0f;
    }
    CHECK(controller.fault() == Fault::over_current);
    CHECK(periods_beyond >= 1);
    CHECK(periods_beyond <= 2);
  }
}

TEST_CASE("test pulses run in `ready` only, and not for motors or times that make no sense") {
  const Settings settings = control::prepare(tests::paper_parameters());
  const auto enabled_after = [&](Controller controller, const protocol::CommandReport& command) {
    controller.carry_out(command);
    return tests::run(controller, tests::samples_at_rest(), settings, 2).enabled;
  };
  CHECK(enabled_after(tests::ready_controller(settings), pulse(Command::test_voltage, 1, 1.0f, 0.1f)));
  CHECK_FALSE(enabled_after(tests::started_controller(settings), pulse(Command::test_voltage, 1, 1.0f, 0.1f)));
  CHECK_FALSE(enabled_after(tests::ready_controller(settings), pulse(Command::test_voltage, 0, 1.0f, 0.1f)));
  CHECK_FALSE(enabled_after(tests::ready_controller(settings), pulse(Command::test_current, 4, 1.0f, 0.1f)));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK_FALSE(enabled_after(tests::ready_controller(settings), pulse(Command::test_current, 1, 1.0f, nan)));
  CHECK_FALSE(enabled_after(tests::ready_controller(settings), pulse(Command::test_current, 1, nan, 0.1f)));
  CHECK_FALSE(enabled_after(tests::ready_controller(settings), pulse(Command::test_current, 1, 1.0f, -1.0f)));
}

TEST_CASE("a test pulse ends with a stop, a host that falls silent and an arm that gets too fast") {
  const Settings settings = control::prepare(tests::paper_parameters());
  const auto started = [&settings] {
    Controller controller = tests::ready_controller(settings);
    controller.carry_out(pulse(Command::test_current, 1, 1.0f, 0.4f));
    CHECK(tests::run(controller, tests::samples_at_rest(), settings, 20).enabled);
    return controller;
  };
  for (const Command last : {Command::stop, Command::disable_force}) {
    CAPTURE(static_cast<int>(last));
    Controller controller = started();
    controller.carry_out(tests::command(last));
    CHECK_FALSE(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
  }

  Controller silent = started();
  const auto patience_periods = static_cast<int>(settings.limits.host_timeout_periods);
  CHECK(tests::run(silent, tests::samples_at_rest(), settings, patience_periods - 20).enabled);
  CHECK_FALSE(tests::run(silent, tests::samples_at_rest(), settings, 1).enabled);
  CHECK(silent.state() == State::ready);
  silent.host_alive();
  CHECK_FALSE(tests::run(silent, tests::samples_at_rest(), settings, 2).enabled);

  Controller fast = started();
  Samples samples = tests::samples_at_rest();
  const auto speed_m_per_s = [&fast] {
    const auto signals = fast.signals();
    return std::hypot(signals[Signal::velocity_x_m_s], signals[Signal::velocity_y_m_s],
                      signals[Signal::velocity_z_m_s]);
  };
  const float limit_m_per_s = tests::paper_parameters()[protocol::Parameter::speed_limit_m_per_s];
  bool enabled = true;
  for (int i = 0; i < 100 && enabled; ++i) {
    for (auto& counts : samples.encoder_counts) counts += 5;
    enabled = tests::run(fast, samples, settings, 1).enabled;
    CHECK(enabled == (speed_m_per_s() <= limit_m_per_s));
  }
  CHECK_FALSE(enabled);
  CHECK(fast.state() == State::ready);
}

TEST_CASE("a test pulse transfers at most the energy reserve for either encoder direction, and a rest follows it") {
  constexpr float reserve_J = 0.004f, current_A = 0.5f, duration_s = 0.1f;
  protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
  set[protocol::Parameter::energy_reserve_J] = reserve_J;
  const Settings settings = control::prepare(set);
  const float step_J =
      std::fabs(current_A * settings.motor_model.back_emf_Vs_per_rad[1] * settings.encoders.rad_per_count[1]);
  for (const Command which : {Command::test_current, Command::test_voltage})
    for (const int periods_per_count : {4, -4, 0}) {  // about 4 rad/s
      CAPTURE(static_cast<int>(which));
      CAPTURE(periods_per_count);
      Controller controller = tests::ready_controller(settings);
      Samples samples = tests::samples_at_rest();
      samples.current_A[1] = current_A;
      controller.carry_out(pulse(which, 2, 1.0f, duration_s));
      double moved_J = 0.0;
      int pulse_periods = 0, rest_periods = 0;
      for (int period = 0; period < 4'000; ++period) {
        if (periods_per_count != 0 && period % periods_per_count == 0) {
          samples.encoder_counts[1] += periods_per_count > 0 ? 1 : -1;
          moved_J += static_cast<double>(step_J);
        }
        controller.host_alive();
        if (!tests::run(controller, samples, settings, 1).enabled) break;
        const bool is_driven = which == Command::test_current
                                   ? controller.signals()[Signal::current_reference_2_A] != 0.0f
                                   : controller.signals()[Signal::duty_2] != 0.0f;
        ++(is_driven ? pulse_periods : rest_periods);
        if (is_driven) CHECK(moved_J < 1.1 * static_cast<double>(reserve_J));
      }
      CHECK(rest_periods == doctest::Approx(2'000).epsilon(1e-3));
      const double to_reserve = 4.0 * static_cast<double>(reserve_J / step_J);
      CHECK(pulse_periods == doctest::Approx(periods_per_count == 0 ? 2'000.0 : to_reserve).epsilon(0.1));
      CHECK(controller.state() == State::ready);
    }
}

TEST_CASE("a hot motor's pulse is held back") {
  protocol::ParameterSet set = tests::without_motors(tests::paper_parameters());
  set[protocol::Parameter::force_limit_N] = info(protocol::Parameter::force_limit_N).maximum;
  set[protocol::Parameter::winding_time_constant_s] = 0.25f;
  set[protocol::Parameter::winding_heat_part] = 1.0f;
  const float continuous_A = set[protocol::Parameter::continuous_current_2_A];
  Settings settings = control::prepare(set);
  settings.motor_model.resistance_ohm = {};  // otherwise the motor check reports the current as implausible
  Controller controller = tests::ready_controller(settings);
  auto warm = tests::samples_at_rest();
  warm.current_A[1] += continuous_A;
  controller.carry_out(tests::command(Command::enable_force));
  for (int i = 0; i < 40'000; ++i) {
    controller.host_alive();
    tests::run(controller, warm, settings, 1);
  }
  REQUIRE(controller.force_is_on());
  controller.carry_out(tests::command(Command::stop));
  tests::run(controller, tests::samples_at_rest(), settings, 1);
  controller.carry_out(pulse(Command::test_current, 2, 99.0f, 0.01f));
  tests::run(controller, warm, settings, 1);
  CHECK(controller.signals()[Signal::current_reference_2_A] == doctest::Approx(continuous_A).epsilon(0.02));
}

}  // namespace
