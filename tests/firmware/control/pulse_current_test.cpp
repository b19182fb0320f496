// Tests the allowed currents during the self-test pulses.
#include <doctest/doctest.h>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::Controller;
using control::Samples;
using control::Settings;
using protocol::Fault;

Settings plain_settings() { return control::prepare(tests::paper_parameters()); }

/// Returns a controller that has just started the pulses.
Controller controller_in_pulses(const Settings& settings) {
  Controller controller = tests::ready_controller(settings);
  tests::run(controller, tests::samples_at_rest(), settings, 300);
  controller.start_pulses(control::PulseSize::of(settings.motor_model.resistance_ohm));
  tests::run(controller, tests::samples_at_rest(), settings, 3);
  REQUIRE(controller.pulses_run());
  return controller;
}

TEST_CASE("during self-test pulses, the over-current limit of a motor is the maximum pulse current") {
  Settings settings = plain_settings();
  settings.limits.over_current_A[1] = 0.5f;
  for (const float current_A : {1.0f, 1.1f}) {
    CAPTURE(current_A);
    Controller controller = controller_in_pulses(settings);
    Samples samples = tests::samples_at_rest();
    samples.current_A[1] = current_A;
    tests::run(controller, samples, settings, 2);
    CHECK(controller.fault() == (current_A < control::SelfTestPulses::maximum_A ? Fault::none : Fault::over_current));
  }
}

TEST_CASE("during self-test pulses, a reading near a rail of any motor immediately raises over_current") {
  Settings settings = plain_settings();
  settings.limits.over_current_A.fill(100.0f);
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    Controller controller = controller_in_pulses(settings);
    Samples samples = tests::samples_at_rest();
    REQUIRE(controller.fault() == Fault::none);
    samples.current_A[motor] = tests::board_limits.current_measurable_A + 0.01f;
    tests::run(controller, samples, settings, 1);
    CHECK(controller.fault() == Fault::over_current);
  }
}

TEST_CASE("a current limit that is lowered during self-test pulses applies immediately") {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    Settings settings = plain_settings();
    settings.limits.over_current_A.fill(3.0f);
    Controller controller = controller_in_pulses(settings);
    Samples samples = tests::samples_at_rest();
    samples.current_A[motor] = 1.2f * control::SelfTestPulses::maximum_A;
    tests::run(controller, samples, settings, 3);
    REQUIRE(controller.fault() == Fault::none);
    settings.limits.over_current_A.fill(0.5f);
    tests::run(controller, samples, settings, 1);
    CHECK(controller.fault() == Fault::over_current);
  }
}

}  // namespace
