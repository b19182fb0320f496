// Tests the complete signal path, from samples to duty cycles.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/firmware/control/controller_names.hpp"
#include "tests/firmware/control/near_wall.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::tests::controller_names;

/// Moves joints 2 and 3 so that the probe moves outward along x, more slowly than the speed limit.
void push_into_wall(Controller& controller, Samples& samples, const Settings& settings) {
  for (int i = 0; i < 100; ++i) {
    if (i % 2 == 0) --samples.encoder_counts[1];
    ++samples.encoder_counts[2];
    controller.host_alive();
    tests::run(controller, samples, settings, 20);
  }
}

TEST_CASE("from power-up through the inkwell to force, with the bridges off until it is on") {
  const Settings settings = settings_near_wall();
  Controller controller{tests::board_limits};
  Samples samples = tests::samples_at_rest();
  CHECK(controller.state() == State::starting);
  CHECK_FALSE(tests::run(controller, samples, settings, 1'000).enabled);
  CHECK(controller.state() == State::starting);
  CHECK_FALSE(tests::run(controller, samples, settings, 1'099).enabled);
  CHECK(controller.state() == State::testing);
  controller.pass_self_test({});
  CHECK_FALSE(tests::run(controller, samples, settings, 1).enabled);
  CHECK(controller.state() == State::unreferenced);
  controller.carry_out(tests::command(Command::enable_force));
  CHECK_FALSE(tests::run(controller, samples, settings, 10).enabled);
  CHECK(controller.state() == State::unreferenced);
  samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
  tests::run(controller, samples, settings, 2'200);
  CHECK(controller.state() == State::ready);
  CHECK(controller.switches() == samples.switches);
  controller.carry_out(tests::command(Command::enable_force));
  CHECK_FALSE(tests::run(controller, samples, settings, 1).enabled);
  CHECK(protocol::force_is_on(controller.state()));
  CHECK(tests::run(controller, samples, settings, 1).enabled);
  CHECK(controller.periods() == 4'312);
}

TEST_CASE("the encoders are referenced in the inkwell for any initial counts") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::started_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.encoder_counts = {500, -70'000, 123'456};
  samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
  tests::run(controller, samples, settings, 2'200);
  samples.encoder_counts[1] += 10;
  tests::run(controller, samples, settings, 1);
  CHECK(controller.signals()[Signal::encoder_1_counts] == 0.0f);
  CHECK(controller.signals()[Signal::encoder_2_counts] == 10.0f);
  CHECK(controller.signals()[Signal::joint_1_rad] == 0.0f);
  CHECK(controller.signals()[Signal::joint_2_rad] ==
        doctest::Approx(0.9f + 10.0f * settings.encoders.rad_per_count[1]));
  CHECK(controller.signals()[Signal::joint_3_rad] == -2.0f);
}

TEST_CASE("in the wall: F = k d, torque by virtual work, current from torque, and T1z is zero") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();
  run_with_host(controller, samples, settings, 4'000);
  CHECK(controller.signals()[Signal::force_N] == 0.0f);
  push_into_wall(controller, samples, settings);
  run_with_host(controller, samples, settings, 12'000);  // at rest with zero speed

  const protocol::SignalValues& signals = controller.signals();
  REQUIRE(protocol::force_is_on(controller.state()));
  const float depth_m = -signals[Signal::penetration_x_m];
  CHECK(depth_m > 0.0005f);
  CHECK(signals[Signal::force_x_N] == doctest::Approx(-800.0f * depth_m).epsilon(1e-4));
  CHECK(signals[Signal::force_N] == doctest::Approx(800.0f * depth_m).epsilon(1e-4));
  CHECK(signals[Signal::force_y_N] == 0.0f);
  CHECK(signals[Signal::torque_1_Nm] == 0.0f);
  const control::Triple joints{signals[Signal::joint_1_rad], signals[Signal::joint_2_rad],
                               signals[Signal::joint_3_rad]};
  const control::Triple torque = control::joint_torques(control::forward_kinematics(joints, settings.arm).jacobian,
                                                        {signals[Signal::force_x_N], 0.0f, 0.0f});
  CHECK(signals[Signal::torque_2_Nm] == torque[1]);
  CHECK(signals[Signal::torque_3_Nm] == torque[2]);
  CHECK(signals[Signal::current_reference_3_A] == doctest::Approx(torque[2] * settings.motors.ampere_per_Nm[2]));
  CHECK(signals[Signal::velocity_x_m_s] == 0.0f);
  // No current flows in this test, so the current loops apply the maximum voltage.
  CHECK(signals[Signal::duty_2] * signals[Signal::current_reference_2_A] > 0.0f);
  CHECK(std::abs(signals[Signal::duty_2]) ==
        doctest::Approx(settings.current_loop.voltage_limit_V / board::supply_nominal_V).epsilon(1e-3));
  CHECK(signals[Signal::duty_1] == doctest::Approx(0.0f));
}

TEST_CASE("every signal of the table is written") {
  constexpr float unwritten = -12345.0f;
  protocol::SignalValues signals;
  signals.values.fill(unwritten);
  Controller{tests::board_limits}.write_signals(signals);
  for (std::size_t i = 0; i < protocol::signal_count; ++i)
    CHECK_MESSAGE(signals.values[i] != unwritten,
                  protocol::signal_table[i].name << " has no line in Controller::write_signals()");
}

TEST_CASE("the force ramps up over force_ramp_s and switches off immediately") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  push_into_wall(controller, samples, settings);
  tests::run(controller, samples, settings, 12'000);
  const float depth_m = -controller.signals()[Signal::penetration_x_m];
  REQUIRE(depth_m > 0.0005f);
  CHECK(controller.signals()[Signal::force_N] == 0.0f);

  controller.carry_out(tests::command(Command::enable_force));
  tests::run(controller, samples, settings, 1);
  float before = 0.0f;
  float largest_rise = 0.0f;
  for (int i = 0; i < 1'000; ++i) {
    run_with_host(controller, samples, settings, 1);
    largest_rise = std::max(largest_rise, controller.signals()[Signal::force_N] - before);
    before = controller.signals()[Signal::force_N];
  }
  CHECK(before == doctest::Approx(0.5f * 800.0f * depth_m).epsilon(0.01));
  CHECK(largest_rise < 800.0f * depth_m / 1'900.0f);
  run_with_host(controller, samples, settings, 1'100);
  CHECK(controller.signals()[Signal::force_N] == doctest::Approx(800.0f * depth_m).epsilon(1e-3));

  controller.carry_out(tests::command(Command::stop));
  const Drive drive = tests::run(controller, samples, settings, 1);
  CHECK_FALSE(drive.enabled);
  CHECK(drive.duty == control::Triple{});
  CHECK(controller.state() == State::ready);
  tests::run(controller, samples, settings, 1);
  CHECK(controller.signals()[Signal::force_N] == 0.0f);
}

TEST_CASE("a silent host switches the force off after host_timeout_s, and not while it speaks") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::active_controller(settings);
  for (int i = 0; i < 20; ++i) {
    tests::run(controller, tests::samples_at_rest(), settings, 900);
    controller.host_alive();
  }
  CHECK(protocol::force_is_on(controller.state()));
  tests::run(controller, tests::samples_at_rest(), settings, 1'000);
  CHECK(protocol::force_is_on(controller.state()));
  CHECK_FALSE(tests::run(controller, tests::samples_at_rest(), settings, 1).enabled);
  CHECK(controller.fault() == Fault::host_silent);
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, tests::samples_at_rest(), settings, 1);
  CHECK(controller.state() == State::ready);
}

TEST_CASE("every signal of the table is written, stage times of this period and of the one before") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  tests::FakeClock clock;
  controller.step(samples, settings, clock);
  controller.finish(clock);
  controller.step(samples, settings, clock);
  const protocol::SignalValues& signals = controller.signals();
  CHECK(signals[Signal::servo_cycles] == 1 + 2 + 3 + 4 + 5 + 6);
  CHECK(controller.servo_cycles() == 21);
  CHECK(signals[Signal::stage_sample_cycles] == 7.0f);
  CHECK(signals[Signal::stage_current_cycles] == 11.0f);
  CHECK(signals[Signal::stage_report_cycles] == 6.0f);
  CHECK(signals[Signal::supply_V] == doctest::Approx(board::supply_nominal_V));
}

TEST_CASE("the angles of the gimbal, one a period in turn") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.gimbal_ratio = {0.25f, 0.5f, 1.0f};
  tests::run(controller, samples, settings, 3);
  const protocol::SignalValues signals = controller.signals();
  for (std::size_t i = 0; i < 3; ++i) {
    const control::GimbalCurve& curve = settings.gimbal[i];
    const float r = samples.gimbal_ratio[i];
    CHECK(signals[of_axis(Signal::gimbal_1_rad, i)] ==
          doctest::Approx(curve.square_rad * r * r + curve.slope_rad * r + curve.offset_rad));
  }
}

}  // namespace
