// Current sensor readings: offsets, drift and plausibility.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "tests/firmware/control/controller_names.hpp"
#include "tests/firmware/control/near_wall.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::tests::controller_names;

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

TEST_CASE(
    "a current sensor whose offset drifts while the bridges are off raises a fault in every state without a force") {
  const Settings settings = settings_near_wall();
  constexpr float drift_A = control::CurrentOffsets::plausible_A;
  for (Controller controller : {tests::started_controller(settings), tests::ready_controller(settings)}) {
    Samples samples = tests::samples_at_rest();
    samples.current_A[2] = -0.9f * drift_A;
    tests::run(controller, samples, settings, 1'000);
    CHECK(controller.fault() == Fault::none);
    samples.current_A[2] = -1.1f * drift_A;
    tests::run(controller, samples, settings, control::CurrentOffsets::patience_periods - 1);
    samples.current_A[2] = 0.0f;  // the current of the switched-off winding has decayed by then
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
    "readings from before a force period or before the offset measurement do not count towards a current sensor "
    "fault") {
  const Settings settings = settings_near_wall();
  constexpr std::uint32_t patience_periods = control::CurrentOffsets::patience_periods;
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.current_A[0] = 0.28f;
  tests::run(controller, samples, settings, patience_periods - 20);
  controller.carry_out(tests::command(Command::enable_force));
  run_with_host(controller, samples, settings, 1);
  REQUIRE(controller.force_is_on());
  samples.current_A[0] = 0.0f;
  run_with_host(controller, samples, settings, 100);
  controller.carry_out(tests::command(Command::stop));
  samples.current_A[0] = 0.28f;  // in a winding that was just switched off
  tests::run(controller, samples, settings, 30);
  samples.current_A[0] = 0.0f;
  tests::run(controller, samples, settings, 10);
  CHECK(controller.state() == State::ready);

  Controller starting{tests::board_limits};
  samples.current_A[1] = 1.0f;  // settling of an amplifier
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

TEST_CASE("a reading near the rail of a current sensor raises over_current for every offset and current limit") {
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

TEST_CASE("a current limit that is restored before the bound has fallen applies again immediately") {
  Settings settings = settings_near_wall();
  settings.limits.over_current_A.fill(2.0f);
  const Settings before = settings;
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  tests::run(controller, samples, settings, 10);
  settings.limits.over_current_A.fill(0.5f);
  tests::run(controller, samples, settings, 15);
  tests::run(controller, samples, before, 3);
  samples.current_A[1] = before.limits.over_current_A[1] - 0.01f;
  tests::run(controller, samples, before, 1);
  CHECK(controller.fault() == Fault::none);
}

TEST_CASE("a lowered current limit raises no fault while the current follows, and then applies") {
  Settings settings = settings_near_wall();
  settings.motor_model.resistance_ohm = {};  // otherwise the motor check reports the current and its jumps
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
  // The current falls by 15 mA per period.
  for (float left_A = current_A; left_A > lowered_A; left_A -= 0.015f) {
    samples.current_A[1] = left_A;
    run_with_host(controller, samples, settings, 1);
    REQUIRE(controller.force_is_on());
  }
  samples.current_A[1] = lowered_A - 0.01f;
  run_with_host(controller, samples, settings, 300);
  CHECK(controller.force_is_on());
  // A raised current limit applies immediately.
  settings.limits.over_current_A[1] = current_A + 0.01f;
  run_with_host(controller, samples, settings, 3);
  samples.current_A[1] = current_A;
  run_with_host(controller, samples, settings, 1);
  CHECK(controller.force_is_on());
  settings.limits.over_current_A[1] = lowered_A;
  run_with_host(controller, samples, settings, 200);
  CHECK(controller.fault() == Fault::over_current);
}

}  // namespace
