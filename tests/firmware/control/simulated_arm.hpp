// Common parts of the controller tests: a clock, samples, and controllers in given states.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "boards/omni_driver/facts.hpp"
#include "firmware/control/controller.hpp"

namespace inkwell::tests {

/// Each stage takes one cycle more than the previous stage.
struct FakeClock {
  std::uint32_t laps = 0;
  std::uint32_t lap() { return ++laps; }
};

inline constexpr control::BoardLimits board_limits{.supply_minimum_V = board::supply_minimum_V,
                                                   .supply_maximum_V = board::supply_maximum_V,
                                                   .duty_limit = board::duty_limit,
                                                   .current_measurable_A = board::omni_driver.current_measurable_A(),
                                                   .dead_time_part = board::omni_driver.bridge_dead_time_part()};

inline control::Samples samples_at_rest() {
  return {.encoder_counts = {},
          .current_A = {},
          .gimbal_ratio = {0.5f, 0.5f, 0.5f},
          .currents_measured = true,
          .supply_V = board::supply_nominal_V,
          .switches = 0,
          .bridge_fault = false,
          .slow_age_periods = 0};
}

inline protocol::CommandReport command(protocol::Command which) {
  protocol::CommandReport report{};
  report.command = which;
  return report;
}

/// Returns the parameters for tests in which no motor current flows. The low voltage limit prevents the detection of a
/// missing motor.
inline protocol::ParameterSet without_motors(protocol::ParameterSet set) {
  set[protocol::Parameter::voltage_limit_V] = 0.9f * control::MotorCheck::tolerance_V;
  return set;
}

/// Runs the controller with unchanged samples.
inline control::Drive run(control::Controller& controller, const control::Samples& samples,
                          const control::Settings& settings, std::uint32_t periods) {
  FakeClock clock;
  control::Drive drive;
  for (std::uint32_t i = 0; i < periods; ++i) {
    drive = controller.step(samples, settings, clock);
    controller.finish(clock);
  }
  return drive;
}

/// Returns the encoder counts at these angles, relative to the inkwell.
inline std::array<std::int32_t, 3> counts_at(const control::Triple& joint_rad, const control::Settings& settings) {
  std::array<std::int32_t, 3> counts;
  for (std::size_t i = 0; i < 3; ++i)
    counts[i] = static_cast<std::int32_t>(
        std::lround((joint_rad[i] - settings.encoders.inkwell_rad[i]) / settings.encoders.rad_per_count[i]));
  return counts;
}

/// Moves to these counts in steps of at most `step_counts` per `step_periods`. The host sends signs of life during the
/// move.
inline void move_to(control::Controller& controller, control::Samples& samples,
                    const std::array<std::int32_t, 3>& there_counts, const control::Settings& settings,
                    std::int32_t step_counts = 15, std::uint32_t step_periods = 1) {
  while (samples.encoder_counts != there_counts) {
    for (std::size_t i = 0; i < 3; ++i)
      samples.encoder_counts[i] +=
          std::clamp<std::int32_t>(there_counts[i] - samples.encoder_counts[i], -step_counts, step_counts);
    controller.host_alive();
    run(controller, samples, settings, step_periods);
  }
}

/// Controller in state `unreferenced`, after the offset measurement and a passed self-test.
inline control::Controller started_controller(const control::Settings& settings,
                                              const control::MeasuredMotors& measured = {},
                                              std::uint32_t first_period = 0) {
  control::Controller controller{board_limits, first_period};
  run(controller, samples_at_rest(), settings, control::CurrentOffsets::duration_periods);
  controller.pass_self_test(measured);
  run(controller, samples_at_rest(), settings, 1);
  return controller;
}

/// Returns a controller in state `ready` whose reference counts are zero. The stylus is outside the inkwell.
inline control::Controller ready_controller(const control::Settings& settings,
                                            const control::MeasuredMotors& measured = {},
                                            std::uint32_t first_period = 0) {
  control::Controller controller = started_controller(settings, measured, first_period);
  control::Samples samples = samples_at_rest();
  samples.switches = static_cast<std::uint8_t>(protocol::Switch::inkwell);
  run(controller, samples, settings,
      control::InkwellReference::still_periods + control::SwitchFilter::settle_periods + 10);
  run(controller, samples_at_rest(), settings, control::SwitchFilter::settle_periods + 10);
  return controller;
}

inline control::Controller active_controller(const control::Settings& settings,
                                             const control::MeasuredMotors& measured = {},
                                             std::uint32_t first_period = 0) {
  control::Controller controller = ready_controller(settings, measured, first_period);
  controller.carry_out(command(protocol::Command::enable_force));
  run(controller, samples_at_rest(), settings, 1);
  return controller;
}

}  // namespace inkwell::tests
