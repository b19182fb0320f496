// Detection of wrong encoder counts. Wrong counts invalidate the reference, independent of the reported fault. The
// reference becomes valid only after the inkwell switch has opened and closed again.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;
using control::Controller;
using control::InkwellReference;
using control::Samples;
using control::Settings;
using control::SwitchFilter;
using protocol::Command;
using protocol::Fault;
using protocol::State;

constexpr auto inkwell_closed = static_cast<std::uint8_t>(protocol::Switch::inkwell);
constexpr std::uint32_t rest_periods = InkwellReference::still_periods + SwitchFilter::settle_periods + 10;

/// Settings without wall forces. The low voltage limit prevents the detection of a missing motor.
Settings free_space(protocol::ParameterSet set = tests::omni_parameters()) {
  set = tests::without_motors(set);
  set[protocol::Parameter::wall_stiffness_N_per_m] = set[protocol::Parameter::wall_damping_Ns_per_m] = 0.0f;
  return control::prepare(set);
}

/// At this speed the arm may move with the force on.
constexpr std::int32_t step_counts = 1;
constexpr std::uint32_t step_periods = 4;

State state_after_clearing(Controller& controller, const Samples& samples, const Settings& settings) {
  controller.carry_out(tests::command(Command::clear_fault));
  tests::run(controller, samples, settings, 1);
  return controller.state();
}

TEST_CASE("a jump of an encoder raises its fault in the same period and makes the reference invalid") {
  const Settings settings = free_space();
  const Controller ready = tests::ready_controller(settings), active = tests::active_controller(settings);
  for (const bool with_force : {false, true})
    for (std::size_t joint = 0; joint < 3; ++joint)
      for (const std::int32_t counts : {17, -17, 400, -400, 20'000})
        for (std::uint32_t instant = 0; instant < 4; ++instant) {
          CAPTURE(with_force);
          CAPTURE(joint);
          CAPTURE(counts);
          CAPTURE(instant);
          Controller controller = with_force ? active : ready;
          Samples samples = tests::samples_at_rest();
          tests::run(controller, samples, settings, 10 + instant);
          samples.encoder_counts[joint] += counts;
          CHECK_FALSE(tests::run(controller, samples, settings, 1).enabled);
          CHECK(controller.fault() == Fault::encoder_implausible);
          CHECK(state_after_clearing(controller, samples, settings) == State::unreferenced);
        }
}

TEST_CASE("an arm as fast as a hand can throw it jumps nowhere") {
  const Settings settings = free_space();
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  for (int i = 0; i < 50; ++i) {
    for (auto& counts : samples.encoder_counts) counts += i % 10 < 5 ? 10 : -10;  // 11 m/s
    tests::run(controller, samples, settings, 1);
    REQUIRE(controller.state() == State::ready);
  }
}

TEST_CASE("an arm with fine encoders may be as fast") {
  protocol::ParameterSet set = tests::omni_parameters();
  for (std::size_t i = 0; i < 3; ++i) set[of_axis(protocol::Parameter::encoder_1_counts_per_turn, i)] = 100'000.0f;
  const Settings settings = free_space(set);
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  for (int i = 0; i < 50; ++i) {
    for (auto& counts : samples.encoder_counts) counts += i % 10 < 5 ? 700 : -700;  // 11 m/s
    tests::run(controller, samples, settings, 1);
    REQUIRE(controller.state() == State::ready);
  }
}

TEST_CASE("a stylus that leaves the inkwell while a button chatters is no stuck switch") {
  const Settings settings = free_space();
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  samples.switches = inkwell_closed;
  tests::run(controller, samples, settings, rest_periods);
  for (int period = 0; period < 2'000; ++period) {
    samples.switches = period / 80 % 2 == 0 ? static_cast<std::uint8_t>(protocol::Switch::button_1) : std::uint8_t{0};
    if (period % 3 == 0) ++samples.encoder_counts[0];
    tests::run(controller, samples, settings, 1);
  }
  CHECK(controller.state() == State::ready);
}

TEST_CASE("a jump with or after another fault also makes the reference invalid") {
  const Settings settings = free_space();
  for (const bool at_once : {true, false}) {
    CAPTURE(at_once);
    Controller controller = tests::active_controller(settings);
    Samples samples = tests::samples_at_rest();
    tests::run(controller, samples, settings, 10);
    samples.bridge_fault = true;
    if (at_once) samples.encoder_counts[1] += 300;
    tests::run(controller, samples, settings, 1);
    CHECK(controller.is_referenced() == !at_once);
    samples.encoder_counts[1] += at_once ? 0 : 300;
    tests::run(controller, samples, settings, 5);
    CHECK(controller.fault() == Fault::bridge_fault);
    CHECK_FALSE(controller.is_referenced());
    samples.bridge_fault = false;
    CHECK(state_after_clearing(controller, samples, settings) == State::unreferenced);
  }
}

TEST_CASE("a closed inkwell's switch far from the inkwell is a fault, with the force on and off; within its play not") {
  for (const tests::Arm& arm : tests::all_arms()) {
    const Settings settings = free_space(arm.parameters);
    const float play_rad =
        0.02f / std::max(arm.parameters[protocol::Parameter::link_2_m], arm.parameters[protocol::Parameter::link_3_m]);
    const Controller ready = tests::ready_controller(settings), active = tests::active_controller(settings);
    for (std::size_t joint = 0; joint < 3; ++joint)
      for (const bool with_force : {false, true})
        for (const float part_of_play : {0.9f, -0.9f, 1.1f, -1.1f}) {
          CAPTURE(arm.name);
          CAPTURE(joint);
          CAPTURE(with_force);
          CAPTURE(part_of_play);
          Controller controller = with_force ? active : ready;
          Samples samples = tests::samples_at_rest();
          auto there_counts = samples.encoder_counts;
          there_counts[joint] =
              static_cast<std::int32_t>(std::lround(part_of_play * play_rad / settings.encoders.rad_per_count[joint]));
          tests::move_to(controller, samples, there_counts, settings, step_counts, step_periods);
          REQUIRE(controller.fault() == Fault::none);
          samples.switches = inkwell_closed;
          controller.host_alive();
          tests::run(controller, samples, settings, SwitchFilter::settle_periods + 8);
          const bool is_far = std::fabs(part_of_play) > 1.0f;
          CHECK(controller.fault() == (is_far ? Fault::inkwell_implausible : Fault::none));
          if (is_far) CHECK(state_after_clearing(controller, samples, settings) == State::unreferenced);
        }
  }
}

TEST_CASE("a switch that closed outside the inkwell sets no reference before it opens") {
  const Settings settings = free_space();
  Controller controller = tests::ready_controller(settings);
  Samples samples = tests::samples_at_rest();
  tests::move_to(controller, samples, {600, 0, 0}, settings, step_counts, step_periods);
  samples.switches = inkwell_closed;
  tests::run(controller, samples, settings, rest_periods);
  REQUIRE(controller.fault() == Fault::inkwell_implausible);
  REQUIRE(state_after_clearing(controller, samples, settings) == State::unreferenced);
  // The short circuit to ground remains while the arm rests at several positions.
  for (const std::int32_t counts : {600, 900, 0}) {
    tests::move_to(controller, samples, {counts, 0, 0}, settings, step_counts, step_periods);
    tests::run(controller, samples, settings, 3 * rest_periods);
    CHECK(controller.state() == State::unreferenced);
  }
  samples.switches = 0;
  tests::run(controller, samples, settings, SwitchFilter::settle_periods + 8);
  samples.switches = inkwell_closed;
  tests::run(controller, samples, settings, rest_periods);
  CHECK(controller.state() == State::ready);
}

}  // namespace
