// The whole signal path, from samples to duties.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

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

/// The paper's arm with a box in which the inkwell's pose is 2 mm inside the upper x wall, without damping.
Settings settings_near_wall() {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::without_motors(tests::paper_parameters());
  const Settings plain = control::prepare(set);
  const control::Vector3 inkwell_m = control::forward_kinematics(plain.encoders.inkwell_rad, plain.arm).position_m;
  set[sphere_radius_m] = 0.0f;
  set[box_minimum_x_m] = 0.05f;
  set[box_maximum_x_m] = inkwell_m.x + 0.002f;
  set[box_minimum_y_m] = -0.2f;
  set[box_maximum_y_m] = 0.2f;
  set[box_minimum_z_m] = -0.2f;
  set[box_maximum_z_m] = 0.2f;
  set[wall_stiffness_N_per_m] = 800.0f;
  set[force_ramp_s] = 0.1f;
  return control::prepare(set);
}

/// Joint 2 back and joint 3 up, so that the probe goes out along x, in steps slow enough for the speed limit.
void push_into_wall(Controller& controller, Samples& samples, const Settings& settings) {
  for (int i = 0; i < 100; ++i) {
    if (i % 2 == 0) --samples.encoder_counts[1];
    ++samples.encoder_counts[2];
    controller.host_alive();
    tests::run(controller, samples, settings, 20);
  }
}

void run_with_host(Controller& controller, const Samples& samples, const Settings& settings, int periods) {
  for (int i = 0; i < periods; ++i) {
    controller.host_alive();
    tests::run(controller, samples, settings, 1);
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

TEST_CASE("the reference is where the stylus was in the inkwell, whatever the counts were") {
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
  run_with_host(controller, samples, settings, 12'000);  // at rest, speed zero

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
  // No current flows in this rig, so the loops push with all the voltage that they may, in the reference's direction.
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

TEST_CASE("the force ramps in over force_ramp_s and goes off at once") {
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

/// Samples that must switch an active controller off in the very period in which they come.
struct BadSample {
  Fault fault;
  void (*spoil)(Samples&);
  std::uint32_t periods;
};

TEST_CASE("what the samples can show wrong switches the bridges off with the right fault") {
  const BadSample cases[] = {
      {Fault::bridge_fault, [](Samples& s) { s.bridge_fault = true; }, 1},
      {Fault::over_current, [](Samples& s) { s.current_A[2] = -3.8f; }, 1},
      {Fault::supply_low, [](Samples& s) { s.supply_V = 9.0f; }, 60},
      {Fault::supply_low, [](Samples& s) { s.supply_V = 5.9f; }, 1},
      {Fault::supply_high, [](Samples& s) { s.supply_V = 25.5f; }, 80},
      {Fault::supply_high, [](Samples& s) { s.supply_V = 26.5f; }, 1},
      {Fault::samples_stale, [](Samples& s) { s.slow_age_periods = 21; }, 1},
      {Fault::samples_stale, [](Samples& s) { s.currents_measured = false; }, 1},
      {Fault::not_finite, [](Samples& s) { s.current_A[0] = std::numeric_limits<float>::quiet_NaN(); }, 1},
      {Fault::not_finite, [](Samples& s) { s.supply_V = std::numeric_limits<float>::infinity(); }, 1},
      {Fault::encoder_implausible, [](Samples& s) { s.encoder_counts[0] += 12'000; }, 1},
  };
  for (const BadSample& row : cases) {
    CAPTURE(static_cast<int>(row.fault));
    const Settings settings = settings_near_wall();
    Controller controller = tests::active_controller(settings);
    Samples samples = tests::samples_at_rest();
    CHECK(tests::run(controller, samples, settings, 5).enabled);
    row.spoil(samples);
    const Drive drive = tests::run(controller, samples, settings, row.periods);
    CHECK(controller.state() == State::fault);
    CHECK(controller.fault() == row.fault);
    CHECK_FALSE(drive.enabled);
    CHECK(drive.duty == control::Triple{});

    samples = tests::samples_at_rest();
    tests::run(controller, samples, settings, 400);
    CHECK(controller.state() == State::fault);
    controller.carry_out(tests::command(Command::clear_fault));
    tests::run(controller, samples, settings, 1);
    CHECK(controller.state() == (row.fault == Fault::encoder_implausible ? State::unreferenced : State::ready));
  }
}

TEST_CASE("a supply that dips or rises for a control period, but not far, is borne") {
  for (const float reading_V : {6.1f, 26.3f}) {
    CAPTURE(reading_V);
    const Settings settings = settings_near_wall();
    Controller controller = tests::active_controller(settings);
    Samples samples = tests::samples_at_rest();
    samples.supply_V = reading_V;
    tests::run(controller, samples, settings, 1);
    tests::run(controller, tests::samples_at_rest(), settings, 20);
    CHECK(controller.fault() == Fault::none);
    CHECK(controller.force_is_on());
  }
}

/// What a ready controller says to an arm that comes to stand so; the third angle is the elbow's, from link 2 to
/// link 3.
Fault fault_at(const Settings& settings, const control::Triple& at_stops_rad) {
  control::Triple joint_rad = at_stops_rad;
  if (settings.arm.transmission == control::Transmission::parallelogram) joint_rad[2] += joint_rad[1];
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::ready_controller(settings);
  tests::move_to(controller, samples, tests::counts_at(joint_rad, settings), settings);
  tests::run(controller, samples, settings, 3);
  return controller.fault();
}

TEST_CASE("a joint beyond its stop is told, the elbow by its angle between the links, and none within") {
  constexpr float beyond_rad = 0.01f;
  for (const tests::Arm& arm : tests::all_arms()) {
    CAPTURE(arm.name);
    const Settings settings = control::prepare(arm.parameters);
    const control::Triple &lower_rad = settings.limits.joint_minimum_rad,
                          &upper_rad = settings.limits.joint_maximum_rad;
    control::Triple middle_rad{};
    for (std::size_t i = 0; i < 3; ++i) middle_rad[i] = 0.5f * (lower_rad[i] + upper_rad[i]);
    const auto with = [](control::Triple at_rad, std::size_t joint, float angle_rad) {
      at_rad[joint] = angle_rad;
      return at_rad;
    };
    for (std::size_t joint = 0; joint < 3; ++joint) {
      CAPTURE(joint);
      CHECK(fault_at(settings, with(middle_rad, joint, lower_rad[joint] - beyond_rad)) == Fault::encoder_implausible);
      CHECK(fault_at(settings, with(middle_rad, joint, lower_rad[joint] + beyond_rad)) == Fault::none);
      CHECK(fault_at(settings, with(middle_rad, joint, upper_rad[joint] - beyond_rad)) == Fault::none);
      CHECK(fault_at(settings, with(middle_rad, joint, upper_rad[joint] + beyond_rad)) == Fault::encoder_implausible);
    }
    // With joints 2 and 3 at their ends together, the third of a parallelogram is far beyond the elbow's stops.
    for (const auto& ends_rad : {lower_rad, upper_rad}) {
      const float inward_rad = ends_rad == lower_rad ? beyond_rad : -beyond_rad;
      CHECK(fault_at(settings, {middle_rad[0], ends_rad[1] + inward_rad, ends_rad[2] + inward_rad}) == Fault::none);
    }
  }
}

TEST_CASE("a probe beyond its speed limit is let go") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();
  for (int i = 0; i < 60 && protocol::force_is_on(controller.state()); ++i) {
    samples.encoder_counts[0] += 8;  // 0.05 rad/ms at the waist
    tests::run(controller, samples, settings, 1);
  }
  CHECK(controller.fault() == Fault::over_speed);
}

TEST_CASE("offsets of the current sensors are taken off, and a broken sensor is found") {
  const Settings settings = settings_near_wall();
  Samples samples = tests::samples_at_rest();
  samples.current_A = {0.05f, -0.03f, 0.0f};
  Controller controller{tests::board_limits};
  tests::run(controller, samples, settings, 2'100);
  CHECK(controller.state() == State::testing);
  CHECK(controller.current_offsets_A()[0] == doctest::Approx(0.05));
  CHECK(std::abs(controller.signals()[Signal::current_1_A]) < 1e-4f);
  CHECK(std::abs(controller.signals()[Signal::current_2_A]) < 1e-4f);

  Controller broken{tests::board_limits};
  samples.current_A[1] = -4.1f;
  tests::run(broken, samples, settings, 2'100);
  CHECK(broken.fault() == Fault::current_sensor);
  broken.carry_out(tests::command(Command::clear_fault));
  tests::run(broken, samples, settings, 10);
  CHECK(broken.fault() == Fault::current_sensor);
}

TEST_CASE("a current sensor that drifts off zero while the bridges are off is told, in every state without a force") {
  const Settings settings = settings_near_wall();
  constexpr float drift_A = control::CurrentOffsets::plausible_A;
  for (Controller controller : {tests::started_controller(settings), tests::ready_controller(settings)}) {
    Samples samples = tests::samples_at_rest();
    samples.current_A[2] = -0.9f * drift_A;
    tests::run(controller, samples, settings, 1'000);
    CHECK(controller.fault() == Fault::none);
    samples.current_A[2] = -1.1f * drift_A;
    tests::run(controller, samples, settings, control::CurrentOffsets::patience_periods - 1);
    samples.current_A[2] = 0.0f;  // the current of a winding that was switched off has ended by then
    tests::run(controller, samples, settings, 1);
    CHECK(controller.fault() == Fault::none);
    samples.current_A[2] = -1.1f * drift_A;
    tests::run(controller, samples, settings, control::CurrentOffsets::patience_periods);
    CHECK(controller.fault() == Fault::current_sensor);
    controller.carry_out(tests::command(Command::clear_fault));
    tests::run(controller, samples, settings, 1);
    CHECK(controller.fault() == Fault::current_sensor);
    samples.current_A[2] = 0.0f;
    controller.carry_out(tests::command(Command::clear_fault));
    tests::run(controller, samples, settings, 1);
    CHECK(controller.state() != State::fault);
  }
}

TEST_CASE(
    "what a sensor read before the force was on is not counted on when it goes, nor what it read before it was "
    "measured") {
  const Settings settings = settings_near_wall();
  constexpr std::uint32_t patience_periods = control::CurrentOffsets::patience_periods;
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.current_A[0] = 0.5f;
  tests::run(controller, samples, settings, patience_periods - 20);
  controller.carry_out(tests::command(Command::enable_force));
  run_with_host(controller, samples, settings, 1);
  REQUIRE(controller.force_is_on());
  samples.current_A[0] = 0.0f;
  run_with_host(controller, samples, settings, 100);
  controller.carry_out(tests::command(Command::stop));
  samples.current_A[0] = 0.5f;  // in a winding that was just switched off
  tests::run(controller, samples, settings, 30);
  samples.current_A[0] = 0.0f;
  tests::run(controller, samples, settings, 10);
  CHECK(controller.state() == State::ready);

  Controller starting{tests::board_limits};
  samples.current_A[1] = 1.0f;  // an amplifier that settles
  tests::run(starting, samples, settings, patience_periods + 50);
  samples.current_A[1] = 0.0f;
  tests::run(starting, samples, settings, control::CurrentOffsets::duration_periods);
  CHECK(starting.state() == State::testing);
}

TEST_CASE("currents while a brake shorts the motors are no drift") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();
  Drive drive;
  for (int i = 0; i < 60 && protocol::force_is_on(controller.state()); ++i) {
    samples.encoder_counts[0] += 8;
    drive = tests::run(controller, samples, settings, 1);
  }
  REQUIRE(drive.brake);
  samples.current_A[0] = 0.6f;
  for (std::uint32_t i = 0; i < 2 * control::CurrentOffsets::patience_periods; ++i) {
    samples.encoder_counts[0] += 8;
    CHECK(tests::run(controller, samples, settings, 1).brake);
  }
  samples.current_A[0] = 0.0f;
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, samples, settings, 10);
  CHECK(controller.state() == State::ready);
}

TEST_CASE("a raised fault is shown, and one from before the start leads back to starting") {
  const Settings settings = settings_near_wall();
  Controller controller{tests::board_limits};
  controller.raise(Fault::watchdog);
  controller.raise(Fault::servo_overrun);
  tests::run(controller, tests::samples_at_rest(), settings, 1);
  CHECK(controller.fault() == Fault::watchdog);
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, tests::samples_at_rest(), settings, 1);
  CHECK(controller.state() == State::starting);
}

TEST_CASE("a motor that gets hot although nothing is asked of it is a fault until it has cooled") {
  protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
  set[protocol::Parameter::winding_time_constant_s] = 0.1f;
  set[protocol::Parameter::winding_heat_part] = 1.0f;
  Settings settings = control::prepare(set);
  settings.motor_model.resistance_ohm = {};  // or it would be told that no voltage explains the current
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();
  const float offset_A = samples.current_A[1];
  samples.current_A[1] = offset_A + 1.3f * set[protocol::Parameter::continuous_current_2_A];
  run_with_host(controller, samples, settings, 10'000);
  CHECK(controller.fault() == Fault::motor_hot);
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, samples, settings, 1);
  CHECK(controller.fault() == Fault::motor_hot);
  samples.current_A[1] = offset_A;
  tests::run(controller, samples, settings, 5'000);
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, samples, settings, 1);
  CHECK(controller.state() == State::ready);
}

TEST_CASE("a motor that was hot before a restart is as hot after it, and goes on to cool") {
  protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
  set[protocol::Parameter::winding_time_constant_s] = 0.2f;
  set[protocol::Parameter::housing_time_constant_s] = 2.0f;
  const Settings settings = control::prepare(set);
  const Samples samples = tests::samples_at_rest();
  Controller controller{tests::board_limits};
  CHECK(controller.warmth().heat == control::Triple{});
  controller.start_warm({{1.0f, 0.5f, 0.25f}, {0.75f, 0.5f, 0.125f}, 0});
  tests::run(controller, samples, settings, 1);
  CHECK(controller.motor_heat() == control::Triple{1.0f, 0.5f, 0.25f});
  CHECK(controller.warmth().heat == control::Triple{1.0f, 0.5f, 0.25f});
  CHECK(controller.warmth().housing == control::Triple{0.75f, 0.5f, 0.125f});
  CHECK(controller.warmth().too_hot == 0);
  tests::run(controller, samples, settings, 4'000);  // 0.2 s
  CHECK(controller.fault() == Fault::none);
  const float winding = std::exp(-1.0f), housing = std::exp(-0.1f);
  CHECK(controller.motor_heat()[0] == doctest::Approx(0.25f * winding + 0.75f * housing).scale(0).epsilon(0.01));
  CHECK(controller.motor_heat()[1] == doctest::Approx(0.5f * housing).scale(0).epsilon(0.01));
  CHECK(controller.motor_heat()[2] == doctest::Approx(0.125f * (winding + housing)).scale(0).epsilon(0.01));

  // What the run before found too hot has to cool as far as it would have had to.
  Controller hot{tests::board_limits};
  hot.start_warm({{1.1f, 0.0f, 0.0f}, {1.1f, 0.0f, 0.0f}, 1});
  CHECK(hot.warmth().too_hot == 1);
  tests::run(hot, samples, settings, 2'200);
  CHECK(hot.motor_heat()[0] < 1.1f);
  CHECK(hot.fault() == Fault::motor_hot);
  CHECK(hot.warmth().too_hot == 1);
  tests::run(hot, samples, settings, 10'000);
  hot.carry_out(tests::command(Command::clear_fault));
  tests::run(hot, samples, settings, 1);
  CHECK(hot.fault() == Fault::none);
}

TEST_CASE("a reading near a rail of its sensor is an over-current whatever offset and current limit are") {
  Settings settings = settings_near_wall();
  settings.limits.over_current_A.fill(100.0f);
  for (const float offset_A : {-0.2f, 0.0f, 0.2f})
    for (const float sign : {-1.0f, 1.0f}) {
      CAPTURE(offset_A);
      CAPTURE(sign);
      Samples samples = tests::samples_at_rest();
      samples.current_A[1] = offset_A;
      Controller controller{tests::board_limits};
      tests::run(controller, samples, settings, 2'100);
      REQUIRE(controller.state() == State::testing);
      const float known_A = tests::board_limits.current_measurable_A - std::fabs(offset_A);
      samples.current_A[1] = sign * (known_A - 0.01f) + offset_A;
      tests::run(controller, samples, settings, 1);
      CHECK(controller.state() == State::testing);
      samples.current_A[1] = sign * (known_A + 0.01f) + offset_A;
      tests::run(controller, samples, settings, 1);
      CHECK(controller.fault() == Fault::over_current);
    }
}

TEST_CASE("a current limit that is lowered gives the current time to follow, and then holds for it") {
  Settings settings = settings_near_wall();
  settings.motor_model.resistance_ohm = {};  // or it would be told that no voltage explains the current
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();
  constexpr float current_A = 2.0f;
  samples.current_A[1] = current_A;
  run_with_host(controller, samples, settings, 10);
  REQUIRE(controller.force_is_on());
  constexpr float lowered_A = 0.5f;
  settings.limits.over_current_A[1] = lowered_A;
  run_with_host(controller, samples, settings, 1);
  CHECK(controller.force_is_on());
  // A current that falls by 15 mA in a period.
  for (float left_A = current_A; left_A > lowered_A; left_A -= 0.015f) {
    samples.current_A[1] = left_A;
    run_with_host(controller, samples, settings, 1);
    REQUIRE(controller.force_is_on());
  }
  samples.current_A[1] = lowered_A - 0.01f;
  run_with_host(controller, samples, settings, 300);
  CHECK(controller.force_is_on());
  // Raised, it holds before a current can have followed.
  settings.limits.over_current_A[1] = current_A + 0.01f;
  run_with_host(controller, samples, settings, 3);
  samples.current_A[1] = current_A;
  run_with_host(controller, samples, settings, 1);
  CHECK(controller.force_is_on());
  settings.limits.over_current_A[1] = lowered_A;
  run_with_host(controller, samples, settings, 200);
  CHECK(controller.fault() == Fault::over_current);
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
