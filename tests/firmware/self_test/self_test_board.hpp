// Main loop, control interrupt and simulated motors of a board in the self-test.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <optional>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"
#include "tests/firmware/control/simulated_motors.hpp"

#include "tests/firmware/link/fresh_link.hpp"

namespace inkwell::test {

/// Runs one control interrupt and one pass of the main loop per period.
struct SelfTestBoard {
  link::Link& link = fresh_link();
  control::Controller controller{tests::board_limits};
  control::Settings settings = control::prepare(tests::confirmed_omni_parameters());
  control::Samples samples = tests::samples_at_rest();
  float analog_supply_V = 3.3f;
  bool analog_supply_is_right = true;
  tests::SimulatedMotors motors;
  control::Triple offset_A{};  ///< offsets of the current sensors
  tests::FakeClock clock;
  control::Drive drive;
  std::optional<protocol::SelfTestItem> floating;  ///< a wire that is not driven
  std::uint32_t follows_by_chance = 0;  ///< number of checks in which a driven wire follows the pull resistors
  std::optional<protocol::SelfTestItem> tested_wire;
  std::uint32_t readings = 0;
  std::uint32_t driven_periods = 0;

  void interrupt() {
    control::Triple requested_V{};
    for (std::size_t i = 0; i < 3; ++i) requested_V[i] = drive.duty[i] * samples.supply_V;
    samples.current_A = motors.step(requested_V);
    for (std::size_t i = 0; i < 3; ++i) samples.current_A[i] += offset_A[i];
    drive = controller.step(samples, settings, clock);
    if (controller.state() == protocol::State::testing) link.self_test.exchange(controller);
    driven_periods += drive.enabled;
    test::interrupt(link, controller.signals(), {.state = controller.state(), .fault = controller.fault()});
  }

  void main_loop() {
    if (!link.self_test.goes_on()) return;
    link.self_test.follow(controller, settings, {samples.gimbal_ratio, analog_supply_V, analog_supply_is_right});
    if (const auto wire = link.self_test.wanted_wire()) {
      CHECK_FALSE(drive.enabled);
      readings = wire == tested_wire ? readings + 1 : 1;
      tested_wire = wire;
      link.self_test.note_wire(wire == floating || readings <= follows_by_chance);
    }
  }

  void run(int periods) {
    for (; periods > 0; --periods) {
      interrupt();
      main_loop();
    }
  }

  /// Runs until the state changes. Returns the number of periods.
  int run_while(protocol::State state) {
    int periods = 0;
    for (; controller.state() == state && periods < 10'000; ++periods) run(1);
    return periods;
  }

  protocol::SelfTestResult result(protocol::SelfTestItem item) const {
    return link.self_test.report().entries[static_cast<std::size_t>(item)].result;
  }
  float figure(protocol::SelfTestItem item) const {
    return link.self_test.report().entries[static_cast<std::size_t>(item)].figure;
  }
};

}  // namespace inkwell::test
