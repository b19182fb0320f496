// Test pulses of one motor, and what stops them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <firmware/control/arms.hpp>
#include <firmware/control/simulated_arm.hpp>

namespace {

using namespace inkwell;
using control::Controller;
using control::Drive;
using control::Samples;
using control::Settings;
using protocol::Command;
using protocol::Fault;
using protocol::Signal;
using protocol::State;

protocol::CommandReport pulse(Command which, std::uint8_t motor, float amplitude, float duration_s) {
  protocol::CommandReport report = tests::command(which);
  report.test = {motor, amplitude, duration_s};
  return report;
}

TEST_CASE("a test pulse of current: its motor only, its time, its limit, then zero for as long") {
  const Settings settings = control::prepare(tests::paper_parameters());
  Controller controller = tests::ready_controller(settings);
  controller.carry_out(pulse(Command::test_current, 2, 99.0f, 0.01f));
  for (int i = 0; i < 200; ++i) {
    CHECK(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
    CHECK(controller.signals()[Signal::current_reference_2_A] == settings.motors.current_limit_A[1]);
    CHECK(controller.signals()[Signal::current_reference_1_A] == 0.0f);
  }
  for (int i = 0; i < 200; ++i) {
    CHECK(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
    CHECK(controller.signals()[Signal::current_reference_2_A] == 0.0f);
  }
  CHECK_FALSE(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
  CHECK(controller.state() == State::ready);
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

TEST_CASE("a test pulse of voltage sets the duty whatever the current does") {
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

/// What the sensor of a motor shows: its amplifier follows the current to 0.2 V below its rails, here 3.6 A.
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

TEST_CASE("a hot motor's pulse is held back") {
  protocol::ParameterSet set = tests::paper_parameters();
  set[protocol::Parameter::winding_time_constant_s] = 0.25f;
  set[protocol::Parameter::winding_heat_part] = 1.0f;
  const float bears_A = set[protocol::Parameter::continuous_current_2_A];
  const Settings settings = control::prepare(set);
  Controller controller = tests::ready_controller(settings);
  auto warm = tests::samples_at_rest();
  warm.current_A[1] += bears_A;
  tests::run(controller, warm, settings, 40'000);
  controller.carry_out(pulse(Command::test_current, 2, 99.0f, 0.01f));
  tests::run(controller, warm, settings, 1);
  CHECK(controller.signals()[Signal::current_reference_2_A] == doctest::Approx(bears_A).epsilon(0.02));
}

}  // namespace
