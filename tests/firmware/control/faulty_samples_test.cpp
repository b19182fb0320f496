// Tests the faults that faulty samples raise.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/firmware/control/controller_names.hpp"
#include "tests/firmware/control/near_wall.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::tests::controller_names;

/// Each sample must switch an active controller off in the same period.
struct BadSample {
  Fault fault;
  void (*spoil)(Samples&);
  std::uint32_t periods;
};

TEST_CASE("each bad sample switches the bridges off and raises the matching fault") {
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

TEST_CASE("a supply reading slightly outside its limits for one control period raises no fault") {
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

/// Returns the fault of a ready controller after a move to these angles. The third angle is the elbow angle from link 2
/// to link 3.
Fault fault_at(const Settings& settings, const control::Triple& at_stops_rad) {
  control::Triple joint_rad = at_stops_rad;
  if (settings.arm.transmission == control::Transmission::parallelogram) joint_rad[2] += joint_rad[1];
  Samples samples = tests::samples_at_rest();
  Controller controller = tests::ready_controller(settings);
  tests::move_to(controller, samples, tests::counts_at(joint_rad, settings), settings);
  tests::run(controller, samples, settings, 3);
  return controller.fault();
}

TEST_CASE(
    "a joint raises encoder_implausible beyond its stops and not within them, and joints 2 and 3 can reach the same "
    "end together") {
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
    // Joints 2 and 3 may reach the same end together.
    for (const auto& ends_rad : {lower_rad, upper_rad}) {
      const float inward_rad = ends_rad == lower_rad ? beyond_rad : -beyond_rad;
      CHECK(fault_at(settings, {middle_rad[0], ends_rad[1] + inward_rad, ends_rad[2] + inward_rad}) == Fault::none);
    }
  }
}

TEST_CASE("a probe above its speed limit raises over_speed and switches the force off") {
  const Settings settings = settings_near_wall();
  Controller controller = tests::active_controller(settings);
  Samples samples = tests::samples_at_rest();
  for (int i = 0; i < 60 && protocol::force_is_on(controller.state()); ++i) {
    samples.encoder_counts[0] += 8;  // 0.05 rad/ms at the waist
    tests::run(controller, samples, settings, 1);
  }
  CHECK(controller.fault() == Fault::over_speed);
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

TEST_CASE("a motor that heats up without a force is a fault until it has cooled") {
  protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
  set[protocol::Parameter::winding_time_constant_s] = 0.1f;
  set[protocol::Parameter::winding_heat_part] = 1.0f;
  Settings settings = control::prepare(set);
  settings.motor_model.resistance_ohm = {};  // otherwise the motor check reports the current as implausible
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

TEST_CASE("a motor has the same heat before and after a restart, and continues to cool") {
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

  // A restart must not change the cooling of a hot motor.
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

}  // namespace
